#pragma once

#include "app/scene/loaded_scene.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

enum class Verb {
    Run,
    Compare,
    Check,
    View,
    Bench,
    BenchPrecision,
    Paper,
    Validate,
    Stress,
    Import,
    Render,
    Export,
    Sweep,
    Ensemble,
    Diff,
    Schema,
    Probe
};

/// How a window begins.
struct ViewOptions {
    int width = 1280, height = 800;  ///< size of the window [screen units]
    bool paused = false;             ///< wait with the first step until somebody asks for it
    std::string beside = {};         ///< a variant of the scene to be shown beside it; empty: none
};

/// Decisions that an import may take this way or that.
struct ImportOptions {
    bool strictFork = false;          ///< no picMethod means PIC, as the PolyPIC fork reads it, whatever `apic` says
    bool trustFrictionAngle = false;  ///< friction_angle, which libWetCloth does not read, counts
    bool roundSections = false;       ///< a missing biradius is the radius, not 0.018 cm
    bool vertexSolver = false;        ///< this program's own solver of fabric in place of the published one
    bool legacyThreadCount = true;    ///< halfThickness and fabricThreadCount of 2018 count
};

/// What the command line says to drench diff, beside --set and --out.
struct DiffOptions {
    std::filesystem::path a, b;        ///< what is expected, and what is held against it
    std::filesystem::path tolerances;  ///< a scene, or a file with its compare.tolerance alone; empty: that of A
    bool subset = false;               ///< pictures that only B has do not count
};

/// The command line.
struct Options {
    Verb verb = Verb::Run;
    std::string scene;                  ///< a scene file; for bench a name in scenes/bench, or a file; for import one of libWetCloth; …
                                        ///< for render and export a folder; for sweep a study; for schema what it is of
    std::vector<std::string> variants;  ///< run, check, bench: at most one; compare: only these
    std::vector<std::string> sets;      ///< "dotted.key=value"
    std::filesystem::path out;          ///< empty: out/<scene>/<variant>
    int threads = 1;                    ///< all verbs but bench, which has benchThreads; stress: so many runs side by side
    bool frames = true, video = true;
    bool asPanel = false;                     ///< pictures are to stand beside others: nothing is written over them
    double runsToFollow = 0.0;                ///< run: what follows in the same command takes so many times as long
    std::filesystem::path resume;             ///< run: go on with the run in this folder
    std::filesystem::path again;              ///< run: repeat the run of this report.json
    std::optional<std::int64_t> fromFrame;    ///< run: from this frame's checkpoint; nothing: the last one
    bool force = false;                       ///< compare, paper: redo variants that are done
    bool quick = false;                       ///< paper, validate, bench precision, stress: shortened
    bool full = false;                        ///< validate: not shortened, as is the default
    std::vector<std::string> cases;           ///< validate, bench precision: names of scenes; none: all
    std::vector<std::filesystem::path> from;  ///< compare: folders of runs that are there, in place of a scene
    bool orRun = false;                       ///< compare: run a scene without variants, or just the one asked for, as run does

    std::vector<std::string> scenes;                                       ///< stress: files, or names in scenes/; none: the paper's
    std::vector<std::string> methods;                                      ///< stress: like polypic_8; none: all
    std::vector<double> stepFactors;                                       ///< stress: time steps, in published ones; none: 0.5 to 20, quick: 1 to 20
    bool largestOnly = false;                                              ///< stress: no shorter steps than the largest stable one
    std::string parameter;                                                 ///< stress: another parameter that is varied
    std::vector<double> parameterFactors = {0.01, 0.1, 1.0, 10.0, 100.0};  ///< stress: factors of that parameter [-]
    double duration = 0.0;         ///< stress: simulated time of each run [s]; 0: enough for the first moments
    int randomScenes = 0;          ///< stress: number of random scenes to be run instead
    int firstScene = 0;            ///< stress: number of the first random scene
    std::uint64_t seed = 1;        ///< stress: seed of the random scenes
    double limitSeconds = 3600.0;  ///< stress: a run is ended that takes longer

    std::vector<std::string> formats;  ///< export: of geometry files; none: as the scene says
    std::filesystem::path probes;      ///< probe: a file with the section; empty: as the scene says
    int jobs = 1;                      ///< sweep, ensemble: runs side by side
    bool onSlurm = false;              ///< sweep, ensemble: hand the runs to Slurm
    bool wait = true;                  ///< sweep, ensemble: wait until Slurm has done the runs
    std::optional<std::size_t> task;   ///< sweep: do this run alone, as a job of Slurm's does

    int members = 20;               ///< ensemble: how many runs
    int firstMember = 0;            ///< ensemble: number of the first run
    bool framesOfAll = false;       ///< ensemble: with pictures of all of them
    std::vector<std::string> vary;  ///< ensemble: seed, positions, key=a..b; none: positions
    int paperRepeats = 1;           ///< paper: runs of each, with other particles
    double confidence = 0.99;       ///< compare: of all intervals of ensembles together

    ViewOptions view;  ///< view: how the window begins

    ImportOptions import;  ///< import: what may be decided this way or that; its result goes to `out`

    DiffOptions diff;  ///< diff: what is compared, and how

    std::vector<int> benchThreads = {1};
    int repeats = 3;
    int steps = 20, warmupSteps = 2;
    bool csv = false;
    std::filesystem::path results = "tests/bench/results";
    std::string machine;  ///< names the folder of bench's CSV; empty: after the processor

    /// The scene with the variant asked for, if any.
    SceneRequest request() const { return {scene, variants.empty() ? "" : variants.front(), sets}; }
};

/// Nothing when the command line only asked for help, the version or the names of the verbs, which are then on standard output.
/// Throws InputError, one line.
std::optional<Options> readOptions(int argc, const char* const* argv);

}  // namespace app
