#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#ifdef __SANITIZE_THREAD__
#include <exception>
#include <thread>
#include <vector>
#else
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#endif

// Every parallel loop in sim/ goes through one of these. Each gives the same bits for any
// number of threads: results never depend on which thread ran what, or in which order.

namespace sim {

#ifdef __SANITIZE_THREAD__
// ThreadSanitizer cannot see into a libtbb built without it and reports races that are not
// there (google/sanitizers#1004). Four plain threads let it watch our own loop bodies.
inline constexpr int kPlainThreads = 4;
#endif

/// Indices that one task takes where the body does little.
inline constexpr std::size_t kGrain = 1024;

/// How many workers may run loop bodies at once: the size of scratch memory that is indexed by worker.
inline int workerCount()
{
#ifdef __SANITIZE_THREAD__
    return kPlainThreads;
#else
    return tbb::this_task_arena::max_concurrency();
#endif
}

/// Run body(i, worker) for i in [0, n), one task per `grain` indices. body(i, worker) writes only what i owns and the scratch
/// memory of its worker, 0 ≤ worker < workerCount(), whose contents never outlive the body.
template <class Body>
void parallelForWorkers(std::size_t n, std::size_t grain, Body&& body)
{
#ifdef __SANITIZE_THREAD__
    static_cast<void>(grain);
    std::array<std::exception_ptr, kPlainThreads> failures{};
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < kPlainThreads; ++t)
            threads.emplace_back([&, t] {
                try {
                    for (std::size_t i = t; i < n; i += kPlainThreads) body(i, t);
                } catch (...) {
                    failures[t] = std::current_exception();
                }
            });
    }
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
#else
    if (n == 0) return;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, grain),
        [&](const tbb::blocked_range<std::size_t>& range) {
            const int worker = std::max(0, tbb::this_task_arena::current_thread_index());
            for (std::size_t i = range.begin(); i != range.end(); ++i) body(i, worker);
        },
        tbb::simple_partitioner());
#endif
}

/// Run body(i) for i in [0, n); body(i) writes only what i owns. One task per `grain` indices.
template <class Body>
void parallelFor(std::size_t n, std::size_t grain, Body&& body)
{
    parallelForWorkers(n, grain, [&](std::size_t i, int) { body(i); });
}

/// One task per index: for bodies that do a block's or a chunk's work.
template <class Body>
void parallelFor(std::size_t n, Body&& body)
{
    parallelFor(n, 1, body);
}

inline constexpr std::size_t kMaxChunks = 256;

/// The fixed split of n indices into at most kMaxChunks runs of equal length: it depends on n alone.
struct Chunks {
    explicit Chunks(std::size_t n) : total(n), size(std::max<std::size_t>(1, (n + kMaxChunks - 1) / kMaxChunks)) {}
    std::size_t count() const { return (total + size - 1) / size; }
    std::size_t begin(std::size_t chunk) const { return chunk * size; }
    std::size_t end(std::size_t chunk) const { return std::min(total, (chunk + 1) * size); }
    std::size_t total, size;
};

/// combine(... combine(combine(identity, f(0)), f(1)) ..., f(n-1)) with fixed chunks, joined in order.
template <class T, class F, class Combine>
T parallelReduce(std::size_t n, T identity, F&& f, Combine&& combine)
{
    const Chunks chunks(n);
    std::array<T, kMaxChunks> partial;
    parallelFor(chunks.count(), [&](std::size_t c) {
        T sum = identity;
        for (std::size_t i = chunks.begin(c); i < chunks.end(c); ++i) sum = combine(sum, f(i));
        partial[c] = sum;
    });
    T sum = identity;
    for (std::size_t c = 0; c < chunks.count(); ++c) sum = combine(sum, partial[c]);
    return sum;
}

/// Σ f(i) for i in [0, n).
template <class F>
double parallelSum(std::size_t n, F&& f)
{
    return parallelReduce(n, 0.0, f, [](double a, double b) { return a + b; });
}

/// max of 0 and all f(i); a NaN among them stays a NaN.
template <class F>
double parallelMax(std::size_t n, F&& f)
{
    return parallelReduce(n, 0.0, f, [](double a, double b) { return b > a || b != b ? b : a; });
}

}  // namespace sim
