#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace app {

/// A bounded first-in first-out queue between two threads. A full queue makes the producer wait, so that nothing is ever
/// dropped; a failure of either side reaches the other at its next call.
template <class T>
class FrameQueue {
 public:
    explicit FrameQueue(std::size_t capacity) : capacity_(capacity) {}

    /// Waits while the queue is full. Throws what the other side failed with; a closed queue takes nothing more.
    void push(T item)
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return failure_ || closed_ || items_.size() < capacity_; });
        if (failure_) std::rethrow_exception(failure_);
        if (closed_) return;
        items_.push_back(std::move(item));
        changed_.notify_all();
    }

    /// The oldest item, waiting for one; nothing once the queue is closed and empty. Throws what the other side failed with.
    std::optional<T> pop()
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return failure_ || closed_ || !items_.empty(); });
        if (failure_) std::rethrow_exception(failure_);
        if (items_.empty()) return std::nullopt;
        T item = std::move(items_.front());
        items_.pop_front();
        changed_.notify_all();
        return item;
    }

    /// No more items will come; those that wait are still handed out.
    void close()
    {
        std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }

    /// One side cannot go on: what waits is dropped and both sides get the reason. The first reason stays.
    void fail(std::exception_ptr reason)
    {
        std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(reason);
        items_.clear();
        changed_.notify_all();
    }

 private:
    const std::size_t capacity_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<T> items_;
    std::exception_ptr failure_;
    bool closed_ = false;
};

}  // namespace app
