#pragma once

#include "sim/core/types.h"
#include "sim/scene/formula.h"

#include <array>
#include <string>
#include <vector>

namespace sim {

/// A velocity that a scene gives as three formulas of x, y, z, like "-y", "x", "0" [cm/s of cm].
class VelocityField {
 public:
    /// Formula `component` and what is wrong with it.
    struct Mistake {
        int component;
        std::string what;
    };

    /// Throws Mistake.
    explicit VelocityField(const std::array<std::string, kAxes>& formulas);

    const std::string& formula(int component) const { return of_[component].text(); }
    /// Throws Mistake where a formula has no finite value. One thread at a time.
    Vec3 at(const Vec3& x) const;
    /// Column b is how it changes along axis b [1/s], by differences over ±h [cm].
    Mat3 gradient(const Vec3& x, double h) const;

 private:
    std::vector<Formula> of_;
};

}  // namespace sim
