#include "sim/fabric/contact/candidate_pool.h"

#include "sim/core/parallel.h"

#include <algorithm>

namespace sim::contact {

void CandidatePool::resize(std::size_t n)
{
    for (AlignedArray<double>* numbers : {&reach, &core, &distance, &p, &q}) {
        numbers->resize(n + kLanes);  // so that packs may read past the last pair
        numbers->resize(n);
    }
    a.resize(n), b.resize(n), vertices.resize(n);
}

void CandidatePool::set(std::size_t place, const FoundPair& pair, const Primitives& primitives)
{
    a[place] = pair.a, b[place] = pair.b, vertices[place] = primitives.vertices(pair.a, pair.b);
    reach[place] = pair.range.reach, core[place] = pair.range.core;
}

void CandidatePool::moveTo(std::size_t place, std::size_t from)
{
    a[place] = a[from], b[place] = b[from], vertices[place] = vertices[from];
    reach[place] = reach[from], core[place] = core[from];
    distance[place] = distance[from], p[place] = p[from], q[place] = q[from];
}

void CandidatePool::clear()
{
    resize(0);
    unmeasured.clear();
}

void CandidatePool::replace(const Primitives& primitives, std::span<const char> dirty, const PairSearch& search)
{
    const Chunks chunks(size());
    std::array<int, kMaxChunks> count{};
    dropped_.resize(size());
    parallelFor(chunks.count(), [&](std::size_t c) {
        int* out = dropped_.data() + chunks.begin(c);
        for (std::size_t i = chunks.begin(c); i < chunks.end(c); ++i)
            if (dirty[a[i]] || dirty[b[i]]) out[count[c]++] = static_cast<int>(i);
    });
    holes_.clear();
    for (std::size_t c = 0; c < chunks.count(); ++c)
        for (int i = 0; i < count[c]; ++i) holes_.push_back(dropped_[chunks.begin(c) + i]);
    found_.clear();
    for (std::size_t task = 0; task < search.tasks(); ++task)
        for (const FoundPair& f : search.found(task))
            if (primitives.kind(f.a) == kind) found_.push_back(&f);

    const std::size_t before = size(), filled = std::min(holes_.size(), found_.size());
    unmeasured.assign(holes_.begin(), holes_.begin() + filled);
    for (std::size_t i = filled; i < found_.size(); ++i) unmeasured.push_back(static_cast<int>(before + i - filled));
    if (found_.size() > filled) resize(before + found_.size() - filled);
    parallelFor(found_.size(), 1024, [&](std::size_t i) { set(unmeasured[i], *found_[i], primitives); });

    // Holes left over are closed by the last pairs; holes among those are cut off with them.
    std::size_t end = size(), last = holes_.size();
    for (std::size_t hole = filled; hole < last; ++hole) {
        while (last > hole && holes_[last - 1] == static_cast<int>(end) - 1) --end, --last;
        if (hole < last) moveTo(holes_[hole], --end);
    }
    resize(end);
}

void PairSorter::sort(std::vector<PairPlace>& pairs, int firsts)
{
    next_.assign(firsts + 1, 0);
    for (const PairPlace& p : pairs) ++next_[p.a + 1];
    for (int a = 0; a < firsts; ++a) next_[a + 1] += next_[a];
    sorted_.resize(pairs.size());
    for (const PairPlace& p : pairs) sorted_[next_[p.a]++] = p;  // next_[a] ends where the run of a does
    pairs.swap(sorted_);
    for (std::size_t i = 1; i < pairs.size(); ++i) {  // the runs are short
        const PairPlace p = pairs[i];
        std::size_t k = i;
        for (; k > 0 && pairs[k - 1].a == p.a && pairs[k - 1].b > p.b; --k) pairs[k] = pairs[k - 1];
        pairs[k] = p;
    }
}

}  // namespace sim::contact
