#pragma once

#include "app/options.h"
#include "app/parts.h"

// One file per verb. Each returns the exit code, or throws.

namespace app {

int runVerbRun(const Options& options, const Parts& parts);
int runVerbCompare(const Options& options, const Parts& parts);
int runVerbCheck(const Options& options, const Parts& parts);
int runVerbView(const Options& options, const Parts& parts);
int runVerbBench(const Options& options, const Parts& parts);
int runVerbBenchPrecision(const Options& options, const Parts& parts);
int runVerbPaper(const Options& options, const Parts& parts);
int runVerbValidate(const Options& options, const Parts& parts);
int runVerbStress(const Options& options, const Parts& parts);
int runVerbRender(const Options& options, const Parts& parts);
int runVerbDiff(const Options& options, const Parts& parts);
int runVerbExport(const Options& options, const Parts& parts);
int runVerbProbe(const Options& options, const Parts& parts);
int runVerbSchema(const Options& options, const Parts& parts);
int runVerbSweep(const Options& options, const Parts& parts);
int runVerbEnsemble(const Options& options, const Parts& parts);
int runVerbImport(const Options& options, const Parts& parts);

}  // namespace app
