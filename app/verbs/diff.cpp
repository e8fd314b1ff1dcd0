#include "app/diff/diff.h"

#include "app/diff/diff_page.h"
#include "app/system/interrupt.h"
#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#include <exception>
#include <new>

namespace app {

namespace {

int printDifferences(const Options& options)
{
    const DiffResult result = diffResults(options.diff, options.sets, stopWanted);
    if (!options.out.empty()) writeDiffPage(result, options.out);
    for (const DiffFinding& finding : result.findings)
        if (!finding.words.empty()) fmt::print("{} {}: {}\n", finding.differs ? "differs" : "within ", finding.what, finding.words);
    fmt::print("{}\n", result.verdict());
    return result.differs() ? 1 : 0;
}

}  // namespace

/// Whatever goes wrong leaves the question open: it must not look like a difference.
int runVerbDiff(const Options& options, const Backends&)
try {
    return withThreads(options.threads, [&] { return printDifferences(options); });
} catch (const std::bad_alloc&) {
    throw sim::InputError("out of memory");
} catch (const std::exception& error) {
    throw sim::InputError(error.what());
}

}  // namespace app
