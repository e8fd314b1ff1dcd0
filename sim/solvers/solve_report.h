#pragma once

namespace sim {

/// What an iterative solve did, or two of which the second finds what is to be added to the solution of the first.
struct SolveReport {
    int iterations = 0;
    double residual = 0.0;  ///< largest, relative to the largest right-hand side [-]
    bool converged = true;
    double scale = 0.0;  ///< largest right-hand side [the caller's unit]
};

}  // namespace sim
