#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace sim {

// The stages of a step in the order in which each first runs, with the names that logs and tables give them.
#define SIM_STAGES(STAGE)                                                                                                    \
    STAGE(Backup, "backup")     /* copies the state to go back to if the step is rejected, mode adaptive */                  \
    STAGE(Rejected, "rejected") /* attempts at the step that were rejected and repeated in halves */                         \
    STAGE(Emit, "emit")                                                                                                      \
    STAGE(Sort, "sort")                                                                                                      \
    STAGE(Obstacles, "obstacles")                                                                                            \
    STAGE(Capture, "capture") /* fabric takes up liquid */                                                                   \
    STAGE(Relax, "relax")                                                                                                    \
    STAGE(ParticlesToGrid, "particles_to_grid")                                                                              \
    STAGE(Viscosity, "viscosity")                                                                                            \
    STAGE(FabricToGrid, "fabric_to_grid") /* vertices to faces, solver grid only */                                          \
    STAGE(Mixture, "mixture")             /* liquid and fabric on the faces that both reach: drag, suction, loads */         \
    STAGE(Cells, "cells")                                                                                                    \
    STAGE(SurfaceTension, "surface_tension")                                                                                 \
    STAGE(Pressure, "pressure")                                                                                              \
    STAGE(StrainCorrection, "strain_correction") /* the pressure again, without the inertia of stretching */                 \
    STAGE(Volume, "volume")                                                                                                  \
    STAGE(FabricCandidates, "fabric_candidates") /* which parts of the fabric may touch within the step */                   \
    STAGE(FabricContact, "fabric_contact")       /* contact forces, and making moves safe */                                 \
    STAGE(FabricElastic, "fabric_elastic")       /* elastic forces, their derivatives and energies, the preconditioner */    \
    STAGE(FabricSolve, "fabric_solve")           /* the linear solves */                                                     \
    STAGE(GridToFabric, "grid_to_fabric")        /* faces to vertices, solver grid only */                                   \
    STAGE(FabricStrain, "fabric_strain")         /* strains of contact on the grid, with separation and friction */          \
    STAGE(Reflection, "reflection")              /* of the velocities about the projected ones, in the first of two steps */ \
    STAGE(Walls, "walls")                                                                                                    \
    STAGE(GridToParticles, "grid_to_particles")                                                                              \
    STAGE(Wicking, "wicking") /* liquid moves in fabric */                                                                   \
    STAGE(Drip, "drip")       /* fabric lets go of liquid that its pores cannot hold */

enum class Stage {
#define SIM_STAGE_ENUMERATOR(stage, name) stage,
    SIM_STAGES(SIM_STAGE_ENUMERATOR)
#undef SIM_STAGE_ENUMERATOR
        Count
};
inline constexpr int kStages = static_cast<int>(Stage::Count);
inline constexpr std::array<std::string_view, kStages> kStageNames = {
#define SIM_STAGE_NAME(stage, name) name,
    SIM_STAGES(SIM_STAGE_NAME)
#undef SIM_STAGE_NAME
};

/// How long each stage of a step took.
struct StageTimes {
    std::array<double, kStages> stageSeconds{};  ///< time of each stage; 0 if it did not run [s]
    std::array<bool, kStages> stageRan{};        ///< whether each stage ran

    void charge(Stage stage, double seconds)
    {
        stageSeconds[static_cast<int>(stage)] += seconds;
        stageRan[static_cast<int>(stage)] = true;
    }
    double seconds() const
    {
        double sum = 0.0;
        for (double s : stageSeconds) sum += s;
        return sum;
    }
};

/// Charges the time from one start() to the next, or to stop(), to a stage.
class StageClock {
 public:
    explicit StageClock(StageTimes& times) : times_(times) {}
    StageClock(const StageClock&) = delete;
    StageClock& operator=(const StageClock&) = delete;
    ~StageClock() { stop(); }

    void start(Stage stage)
    {
        stop();
        last_ = stage;
        isRunning_ = true;
        times_.stageRan[static_cast<int>(stage)] = true;
        begin_ = std::chrono::steady_clock::now();
    }
    void stop()
    {
        if (!isRunning_) return;
        times_.stageSeconds[static_cast<int>(last_)] += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
        isRunning_ = false;
    }
    /// Stage that was started last: the one that failed, if the step did.
    Stage last() const { return last_; }

 private:
    StageTimes& times_;
    Stage last_ = Stage::Emit;
    bool isRunning_ = false;
    std::chrono::steady_clock::time_point begin_;
};

/// The scope of a stage: what runs in it is charged to the stage, or to those stages that callees start themselves.
class StageScope {
 public:
    explicit StageScope(StageClock& clock) : clock_(clock) {}
    StageScope(StageClock& clock, Stage stage) : clock_(clock) { clock.start(stage); }
    StageScope(const StageScope&) = delete;
    StageScope& operator=(const StageScope&) = delete;
    ~StageScope() { clock_.stop(); }

 private:
    StageClock& clock_;
};

}  // namespace sim
