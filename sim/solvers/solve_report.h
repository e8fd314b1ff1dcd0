#pragma once

namespace sim {

/// What an iterative solve did.
struct SolveReport {
    int iterations = 0;
    double residual = 0.0;  ///< largest, relative to the largest right-hand side [-]
    bool converged = true;
};

}  // namespace sim
