#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include <sys/mman.h>

namespace sim {

/// A growable array of plain numbers, aligned for SIMD. Large ones are mapped from the system, very large ones in huge pages, so that what
/// they leave when they grow goes back to it at once and room to grow costs nothing until it is used. It never shrinks
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
    static constexpr std::size_t kLine = 64, kPage = 4096, kHugePage = std::size_t{1} << 21;
    static constexpr std::size_t kLarge = 64 * kPage, kVeryLarge = 2 * kHugePage;

    struct Free {
        std::size_t mapped = 0;  ///< bytes, if they were mapped
        void operator()(T* p) const
        {
            if (mapped > 0) munmap(p, mapped);
            else std::free(p);
        }
    };

    static std::size_t roundUp(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

    /// Zeros, at an address that is a multiple of the size of the pages.
    static std::unique_ptr<T, Free> map(std::size_t bytes, std::size_t page)
    {
        const std::size_t spare = page - kPage;
        void* whole = mmap(nullptr, bytes + spare, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (whole == MAP_FAILED) throw std::bad_alloc();
        char* const begin = static_cast<char*>(whole);
        char* const aligned = begin + (page - reinterpret_cast<std::uintptr_t>(begin) % page) % page;
        if (aligned > begin) munmap(begin, static_cast<std::size_t>(aligned - begin));
        char* const end = begin + bytes + spare;
        if (end > aligned + bytes) munmap(aligned + bytes, static_cast<std::size_t>(end - aligned) - bytes);
        if (page == kHugePage) madvise(aligned, bytes, MADV_HUGEPAGE);
        return {reinterpret_cast<T*>(aligned), Free{bytes}};
    }

    static std::unique_ptr<T, Free> allocate(std::size_t bytes)
    {
        T* p = static_cast<T*>(std::aligned_alloc(kLine, bytes));
        if (p == nullptr) throw std::bad_alloc();
        std::memset(static_cast<void*>(p), 0, bytes);
        return {p, Free{}};
    }

    void grow(std::size_t n)
    {
        const std::size_t needed = n * sizeof(T), unit = needed < kLarge ? kLine : needed < kVeryLarge ? kPage : kHugePage;
        const std::size_t bytes = roundUp(needed, unit);
        std::unique_ptr<T, Free> fresh = unit == kLine ? allocate(bytes) : map(bytes, unit);
        if (size_ > 0) std::memcpy(fresh.get(), data_.get(), size_ * sizeof(T));
        data_ = std::move(fresh);
        capacity_ = bytes / sizeof(T);
    }

    std::unique_ptr<T, Free> data_;
    std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace sim
