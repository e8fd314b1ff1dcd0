#pragma once

#include "app/backends.h"
#include "app/options.h"

// One file per verb. Each returns the exit code, or throws.

namespace app {

int runVerbRun(const Options& options, const Backends& backends);
int runVerbCompare(const Options& options, const Backends& backends);
int runVerbCheck(const Options& options, const Backends& backends);
int runVerbView(const Options& options, const Backends& backends);
int runVerbBench(const Options& options, const Backends& backends);
int runVerbBenchPrecision(const Options& options, const Backends& backends);
int runVerbPaper(const Options& options, const Backends& backends);
int runVerbValidate(const Options& options, const Backends& backends);
int runVerbStress(const Options& options, const Backends& backends);
int runVerbRender(const Options& options, const Backends& backends);
int runVerbDiff(const Options& options, const Backends& backends);
int runVerbExport(const Options& options, const Backends& backends);
int runVerbProbe(const Options& options, const Backends& backends);
int runVerbSchema(const Options& options, const Backends& backends);
int runVerbSweep(const Options& options, const Backends& backends);
int runVerbEnsemble(const Options& options, const Backends& backends);
int runVerbImport(const Options& options, const Backends& backends);

}  // namespace app
