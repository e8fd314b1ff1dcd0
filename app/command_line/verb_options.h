#pragma once

#include "app/options.h"

#include <CLI/CLI.hpp>

// What each verb may be told on the command line. What it says goes into `options`, with the verb that was asked for.

namespace app {

inline constexpr int kMaxThreads = 1024;

// Options that several verbs have: the scene with --set, which is told anew so that it may be left out, one of its variants, and where results go.
CLI::Option* addScene(CLI::App& verb, Options& options);
void addVariant(CLI::App& verb, Options& options);
void addOutput(CLI::App& verb, Options& options);

// run_options.cpp: verbs that simulate scenes.
void addRun(CLI::App& program, Options& options);
void addCompare(CLI::App& program, Options& options);
void addPaper(CLI::App& program, Options& options);
void addSweep(CLI::App& program, Options& options);
void addEnsemble(CLI::App& program, Options& options);
void addView(CLI::App& program, Options& options);

// file_options.cpp: verbs that make files of files.
void addRender(CLI::App& program, Options& options);
void addExport(CLI::App& program, Options& options);
void addDiff(CLI::App& program, Options& options);
void addProbe(CLI::App& program, Options& options);
void addSchema(CLI::App& program, Options& options);
void addImport(CLI::App& program, Options& options);
void addCheck(CLI::App& program, Options& options);

// experiment_options.cpp: verbs that experiment by many runs.
void addValidate(CLI::App& program, Options& options);
void addStress(CLI::App& program, Options& options);
void addBench(CLI::App& program, Options& options);

}  // namespace app
