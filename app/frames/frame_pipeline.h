#pragma once

#include "app/frames/frame_queue.h"
#include "app/frames/frame_snapshot.h"

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace app {

/// A drawn picture: call it with a file name and it is encoded and written there, whole or not at all.
using Picture = std::function<void(const std::filesystem::path&)>;
using DrawFrame = std::function<Picture(FrameSnapshot&)>;

/// The way of a frame to its file: the simulation hands in snapshots, one thread draws them, one writes them, in order.
/// A slow renderer or disk makes submit() wait. What either thread throws comes out of the next submit() or finish().
class FramePipeline {
 public:
    /// @param startRenderer  called once on the drawing thread, since a GL context belongs to a thread
    /// @param depth          snapshots (and pictures) that may wait
    FramePipeline(std::function<DrawFrame()> startRenderer, std::filesystem::path folder, std::size_t depth = 2);
    /// Finishes the frames in hand; failures are lost, so call finish() first.
    ~FramePipeline();
    FramePipeline(const FramePipeline&) = delete;
    FramePipeline& operator=(const FramePipeline&) = delete;

    /// A snapshot to fill in, with the storage of an earlier one where there is one.
    std::unique_ptr<FrameSnapshot> borrow();
    void submit(std::unique_ptr<FrameSnapshot> snapshot);

    /// Wait until every submitted frame is a file, or throw why not. More may be submitted afterwards.
    void drain();
    /// Wait until every submitted frame is a file, or throw why not; no more will come.
    void finish();

 private:
    struct Drawn {
        std::int64_t number = 0;
        Picture picture;
    };
    void drawAll(const std::function<DrawFrame()>& startRenderer);
    void writeAll();
    void stop(std::exception_ptr reason);

    const std::filesystem::path folder_;
    FrameQueue<std::unique_ptr<FrameSnapshot>> toDraw_;
    FrameQueue<Drawn> toWrite_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::int64_t submitted_ = 0, written_ = 0;  ///< frames
    std::vector<std::unique_ptr<FrameSnapshot>> spare_;
    std::exception_ptr failure_;
    std::jthread drawer_, writer_;
};

/// "frame_00012.png"
std::string frameFileName(std::int64_t number);

}  // namespace app
