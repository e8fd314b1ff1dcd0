#include "app/frames/frame_pipeline.h"

#include <fmt/format.h>

namespace app {

std::string frameFileName(std::int64_t number) { return fmt::format("frame_{:05d}.png", number); }

FramePipeline::FramePipeline(std::function<DrawFrame()> startRenderer, std::filesystem::path folder, std::size_t depth)
    : folder_(std::move(folder)), toDraw_(depth), toWrite_(depth)
{
    drawer_ = std::jthread([this, start = std::move(startRenderer)] { drawAll(start); });
    writer_ = std::jthread([this] { writeAll(); });
}

FramePipeline::~FramePipeline() { toDraw_.close(); }

std::unique_ptr<FrameSnapshot> FramePipeline::borrow()
{
    std::lock_guard lock(mutex_);
    if (spare_.empty()) return std::make_unique<FrameSnapshot>();
    auto snapshot = std::move(spare_.back());
    spare_.pop_back();
    return snapshot;
}

void FramePipeline::submit(std::unique_ptr<FrameSnapshot> snapshot)
{
    toDraw_.push(std::move(snapshot));
    std::lock_guard lock(mutex_);
    ++submitted_;
}

void FramePipeline::drain()
{
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failure_ || written_ == submitted_; });
    if (failure_) std::rethrow_exception(failure_);
}

void FramePipeline::finish()
{
    toDraw_.close();
    if (drawer_.joinable()) drawer_.join();
    if (writer_.joinable()) writer_.join();
    if (failure_) std::rethrow_exception(failure_);
}

void FramePipeline::drawAll(const std::function<DrawFrame()>& startRenderer)
try {
    const DrawFrame draw = startRenderer();
    while (auto snapshot = toDraw_.pop()) {
        toWrite_.push({(*snapshot)->number, draw(**snapshot)});
        std::lock_guard lock(mutex_);
        spare_.push_back(std::move(*snapshot));
    }
    toWrite_.close();
} catch (...) {
    stop(std::current_exception());
    toWrite_.close();  // what is drawn already is still written
}

void FramePipeline::writeAll()
try {
    while (auto drawn = toWrite_.pop()) {
        drawn->picture(folder_ / frameFileName(drawn->number));
        std::lock_guard lock(mutex_);
        ++written_;
        changed_.notify_all();
    }
} catch (...) {
    stop(std::current_exception());
    toWrite_.fail(std::current_exception());
}

void FramePipeline::stop(std::exception_ptr reason)
{
    {
        std::lock_guard lock(mutex_);
        if (!failure_) failure_ = reason;
        changed_.notify_all();
    }
    toDraw_.fail(std::move(reason));
}

}  // namespace app
