#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include <sys/mman.h>

namespace sim {

/// A growable array of plain numbers, aligned for SIMD, in huge pages when large. It never shrinks
/// its storage, so that a buffer that lives in the struct that uses it allocates only while it grows.
/// Elements gained by resize are zero the first time their storage is used, then whatever was there.
template <class T>
class AlignedArray {
    static_assert(std::is_trivially_copyable_v<T>);

 public:
    AlignedArray() = default;
    explicit AlignedArray(std::size_t n) { resize(n); }
    AlignedArray(const AlignedArray& other) { *this = other; }
    AlignedArray(AlignedArray&& other) noexcept { swap(other); }
    AlignedArray& operator=(const AlignedArray& other)
    {
        if (this == &other) return *this;
        resize(other.size_);
        if (size_ > 0) std::memcpy(data_.get(), other.data_.get(), size_ * sizeof(T));
        return *this;
    }
    AlignedArray& operator=(AlignedArray&& other) noexcept
    {
        swap(other);
        return *this;
    }
    void swap(AlignedArray& other) noexcept
    {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    /// Keeps the first min(size(), n) elements.
    void resize(std::size_t n)
    {
        if (n > capacity_) grow(std::max(n, capacity_ + capacity_ / 4));
        size_ = n;
    }
    void fill(T value) { std::fill_n(data(), size_, value); }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }

 private:
    struct Free {
        void operator()(T* p) const { std::free(p); }
    };

    void grow(std::size_t n)
    {
        constexpr std::size_t kLine = 64, kHugePage = std::size_t{1} << 21;
        const std::size_t unit = n * sizeof(T) >= 2 * kHugePage ? kHugePage : kLine;
        const std::size_t bytes = (n * sizeof(T) + unit - 1) / unit * unit;
        T* p = static_cast<T*>(std::aligned_alloc(unit, bytes));
        if (p == nullptr) throw std::bad_alloc();
        if (unit == kHugePage) madvise(p, bytes, MADV_HUGEPAGE);
        if (size_ > 0) std::memcpy(p, data_.get(), size_ * sizeof(T));
        std::memset(static_cast<void*>(p + size_), 0, bytes - size_ * sizeof(T));
        data_.reset(p);
        capacity_ = bytes / sizeof(T);
    }

    std::unique_ptr<T, Free> data_;
    std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace sim
