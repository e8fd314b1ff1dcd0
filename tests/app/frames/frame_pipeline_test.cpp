#include "app/frames/frame_pipeline.h"

#include "tests/app/temporary_folder.h"

#include <atomic>
#include <chrono>
#include <latch>
#include <stdexcept>
#include <thread>

namespace app {
namespace {

using namespace std::chrono_literals;

TEST(FrameQueue, HandsOutInTheOrderOfArrival)
{
    FrameQueue<int> queue(3);
    std::jthread producer([&] {
        for (int i = 0; i < 1000; ++i) queue.push(i);
        queue.close();
    });
    int expected = 0;
    while (const auto item = queue.pop()) EXPECT_EQ(*item, expected++);
    EXPECT_EQ(expected, 1000);
}

TEST(FrameQueue, AFullQueueMakesTheProducerWait)
{
    FrameQueue<int> queue(2);
    std::atomic<int> pushed = 0;
    std::jthread producer([&] {
        for (int i = 0; i < 5; ++i) {
            queue.push(i);
            ++pushed;
        }
        queue.close();
    });
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(pushed, 2);
    queue.pop();
    while (pushed < 3) std::this_thread::sleep_for(1ms);
    while (queue.pop()) {
    }
    EXPECT_EQ(pushed, 5);
}

TEST(FrameQueue, FailureOfTheConsumerReachesAWaitingProducer)
{
    FrameQueue<int> queue(1);
    queue.push(1);
    std::latch waiting(1);
    std::jthread consumer([&] {
        waiting.wait();
        queue.fail(std::make_exception_ptr(std::runtime_error("no more room")));
    });
    waiting.count_down();
    EXPECT_THROW(queue.push(2), std::runtime_error);
}

TEST(FrameQueue, FailureOfTheProducerReachesAWaitingConsumer)
{
    FrameQueue<int> queue(1);
    std::jthread producer([&] { queue.fail(std::make_exception_ptr(std::runtime_error("it exploded"))); });
    EXPECT_THROW(queue.pop(), std::runtime_error);
}

TEST(FrameQueue, ClosedIsStillEmptiedFirst)
{
    FrameQueue<int> queue(4);
    queue.push(1);
    queue.push(2);
    queue.close();
    queue.push(3);
    EXPECT_EQ(queue.pop(), 1);
    EXPECT_EQ(queue.pop(), 2);
    EXPECT_EQ(queue.pop(), std::nullopt);
}

/// A pipeline whose pictures only note that they were written.
struct Notes {
    std::mutex mutex;
    std::vector<std::string> written;
    int failAtDrawing = -1, failAtWriting = -1;
    std::chrono::milliseconds drawing = 0ms, writing = 0ms;

    std::function<DrawFrame()> renderer()
    {
        return [this] {
            return [this](FrameSnapshot& snapshot) -> Picture {
                std::this_thread::sleep_for(drawing);
                if (snapshot.number == failAtDrawing) throw std::runtime_error("cannot draw");
                return [this, number = snapshot.number](const std::filesystem::path& file) {
                    std::this_thread::sleep_for(writing);
                    if (number == failAtWriting) throw std::runtime_error("disk full");
                    std::lock_guard lock(mutex);
                    written.push_back(file.filename().string());
                };
            };
        };
    }
};

void submitFrames(FramePipeline& pipeline, int count)
{
    for (int n = 0; n < count; ++n) {
        auto snapshot = pipeline.borrow();
        snapshot->number = n;
        pipeline.submit(std::move(snapshot));
    }
}

std::vector<std::string> firstFrames(int count)
{
    std::vector<std::string> names;
    for (int n = 0; n < count; ++n) names.push_back(frameFileName(n));
    return names;
}

TEST(FramePipeline, WritesEveryFrameInOrder)
{
    Notes notes;
    FramePipeline pipeline(notes.renderer(), "folder");
    submitFrames(pipeline, 200);
    pipeline.finish();
    EXPECT_EQ(notes.written, firstFrames(200));
}

TEST(FramePipeline, ASlowRendererHoldsUpTheSimulation)
{
    Notes notes;
    notes.drawing = 20ms;
    FramePipeline pipeline(notes.renderer(), "folder", 1);
    const auto begin = std::chrono::steady_clock::now();
    submitFrames(pipeline, 8);
    // One is being drawn and one waits: six of them must have been drawn before the last could be handed in.
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 6 * 20ms);
    pipeline.finish();
    EXPECT_EQ(notes.written, firstFrames(8));
}

TEST(FramePipeline, ASlowDiskHoldsUpTheSimulationAndDropsNothing)
{
    Notes notes;
    notes.writing = 10ms;
    FramePipeline pipeline(notes.renderer(), "folder", 1);
    const auto begin = std::chrono::steady_clock::now();
    submitFrames(pipeline, 12);
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 8 * 10ms);
    pipeline.finish();
    EXPECT_EQ(notes.written, firstFrames(12));
}

TEST(FramePipeline, FailureOfTheRendererReachesTheSimulation)
{
    Notes notes;
    notes.failAtDrawing = 3;
    FramePipeline pipeline(notes.renderer(), "folder");
    EXPECT_THROW(
        {
            submitFrames(pipeline, 100);
            pipeline.finish();
        },
        std::runtime_error);
    EXPECT_THROW(pipeline.finish(), std::runtime_error);
    EXPECT_EQ(notes.written, firstFrames(3)) << "frames before the failure are kept";
}

TEST(FramePipeline, FailureOfTheDiskReachesTheSimulationWithItsReason)
{
    Notes notes;
    notes.failAtWriting = 2;
    FramePipeline pipeline(notes.renderer(), "folder");
    try {
        submitFrames(pipeline, 100);
        FAIL() << "a hundred frames went through a full disk";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "disk full");
    }
    EXPECT_EQ(notes.written, firstFrames(2));
}

TEST(FramePipeline, ARendererThatDoesNotStartIsToldAtTheEnd)
{
    FramePipeline pipeline([]() -> DrawFrame { throw std::runtime_error("no OpenGL"); }, "folder");
    EXPECT_THROW(pipeline.finish(), std::runtime_error);
}

TEST(FramePipeline, ADyingSimulationStillGetsItsFramesWritten)
{
    Notes notes;
    notes.drawing = 5ms;
    try {
        FramePipeline pipeline(notes.renderer(), "folder");
        submitFrames(pipeline, 4);
        throw std::runtime_error("the simulation fell over");
    } catch (const std::runtime_error&) {
    }
    EXPECT_EQ(notes.written, firstFrames(4));
}

TEST(FramePipeline, ReusesTheStorageOfSnapshots)
{
    Notes notes;
    FramePipeline pipeline(notes.renderer(), "folder");
    std::vector<const FrameSnapshot*> seen;
    for (int n = 0; n < 50; ++n) {
        auto snapshot = pipeline.borrow();
        if (std::ranges::find(seen, snapshot.get()) == seen.end()) seen.push_back(snapshot.get());
        snapshot->number = n;
        pipeline.submit(std::move(snapshot));
    }
    pipeline.finish();
    // Two may wait to be drawn, one is drawn, one is handed back, one is filled in.
    EXPECT_LE(seen.size(), 5u);
}

}  // namespace
}  // namespace app
