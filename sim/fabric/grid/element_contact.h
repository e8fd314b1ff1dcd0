#pragma once

#include "sim/fabric/fabric.h"
#include "sim/fabric/grid/contact_law.h"

#include <array>
#include <span>
#include <vector>

namespace sim {

inline constexpr std::size_t kElementsPerTask = 256;

/// What a velocity field does to the fabric.
struct FabricMotion {
    std::vector<Mat3> gradient;  ///< ∇u of each element [1/s]
    std::vector<Vec3> velocity;  ///< velocity of each vertex [cm/s]
};

/// How a step would go without the fabric's own forces.
struct PredictedMotion {
    const FabricMotion& motion;
    double h;           ///< [s]
    double cell;        ///< size of the grid's cells [cm]
    double negligible;  ///< acceleration that does not count [cm/s^2]
};

/// Contact at the quadrature points of the fabric, one per yarn edge and then one per face (fabric/grid/README.md, Directions). An
/// element's material directions across the fabric are carried by the velocity gradient on the grid, its directions in
/// the mesh by the vertices. Both are in the gradient and in the Hessian: since the energy does not change when all
/// directions turn together, what turns the mesh acts as the opposite turn of the directions across.
class ElementContact {
 public:
    ElementContact() = default;
    explicit ElementContact(const Fabric& fabric);

    std::size_t size() const { return corners_.size(); }
    /// Directions of all elements at positions x, free of stress (FabricState::across).
    std::vector<Vec3> unstrained(const FabricState& state) const;
    /// Quadrature point of an element [cm].
    Vec3 position(std::size_t e, std::span<const Vec3> x) const { return mean(e, x); }

    /// Token that contact is assembled for a step, until it is assembled anew.
    class Assembled {
        friend ElementContact;
        Assembled() = default;
    };
    /// Energies, stresses and stiffnesses at the present directions and positions. Given a prediction, shear has the
    /// secant of what friction holds in the end, and elements that would accelerate nothing are left out: an elastic
    /// tangent makes what is barely pressed stick, where the return after the step lets it slide.
    Assembled assemble(const FabricState& state, const PredictedMotion* prediction = nullptr);
    /// No element acts.
    Assembled assembleNone();
    /// Contact energy after this prediction of the elements that assemble() left out because it expected no compression of them [erg]. They
    /// would be compressed without resistance.
    double omittedEnergy(const PredictedMotion& prediction) const;
    /// Energy that all elements would gain by this motion, as far as advectDirections() lets them keep it [erg].
    double gain(const PredictedMotion& moved) const;
    /// Assembles those elements too, with this prediction.
    Assembled activate(const Assembled&, const FabricState& state, const PredictedMotion& prediction);
    /// Elements whose contact is active and significant, ascending.
    const std::vector<int>& active() const { return active_; }
    double energy() const;  ///< [erg], of the last assemble

    /// An element at one place: directions, how turning the mesh shows, and stiffness.
    struct Local {
        Mat3 frame;                      ///< Q
        std::array<Vec3, 2> d;           ///< the second of yarns only
        std::array<Vec3, 2> reciprocal;  ///< yarns: q1/length; faces: in-plane reciprocals of t0 and t1 [1/cm]
        Vec3 normal;                     ///< normal, faces only
        std::array<Mat3, 3> stiffness;   ///< ∂²E/∂d², by (d0, d0), (d0, d1), (d1, d1) [erg]
    };
    struct Stress {
        std::array<Vec3, 2> stress;  ///< ∂E/∂d [erg]
        double energy;               ///< [erg]
        bool isActive;
    };
    const Local& local(std::size_t e) const { return local_[e]; }
    const Stress& stress(std::size_t e) const { return stress_[e]; }
    /// Carries the directions with A = I + hG + ½h²G² and lets contact separate and slide (fabric/grid/README.md, Contact law). What is stored of
    /// it grows by no more than the work that the solved stresses took: where the motion went further than its linearisation, strain yields.
    /// @param moved           by the step; x of the state is already that of its end
    /// @param maxOmitted  energy that elements may come to hold together which were left out [erg]
    /// @return                energy of contact with these directions [erg]
    double advectDirections(const PredictedMotion& moved, double maxOmitted, FabricState& state) const;

    /// Corners of an element; −1 for the third of an edge.
    const std::array<int, 3>& corners(std::size_t e) const { return corners_[e]; }
    const std::array<double, 3>& shares(std::size_t e) const { return shares_[e]; }
    /// Elements around each vertex: 3 · element + corner, of vertex v from incidenceBegin()[v] on.
    const std::vector<int>& incidenceBegin() const { return incidenceBegin_; }
    const std::vector<int>& incidence() const { return incidence_; }
    bool isEdge(std::size_t e) const { return e < edges_; }

    /// Σ shares · values at the corners.
    Vec3 mean(std::size_t e, std::span<const Vec3> values) const
    {
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (corners_[e][k] >= 0) sum += shares_[e][k] * values[corners_[e][k]];
        return sum;
    }

 private:
    /// First of an element's directions in FabricState::across.
    std::size_t direction(std::size_t e) const { return e < edges_ ? 2 * e : edges_ + e; }
    void listActive();
    double energyAfter(std::size_t e, const PredictedMotion& prediction) const;
    double energyBound(std::size_t e, const PredictedMotion& moved, double leftOut) const;
    Stress assembleElement(std::size_t e, const FabricState& state, const PredictedMotion* prediction, Local& at) const
    {
        return isEdge(e) ? assembleEdge(e, state, prediction, at) : assembleFace(e, state, prediction, at);
    }
    Stress assembleEdge(std::size_t e, const FabricState& state, const PredictedMotion* prediction, Local& at) const;
    Stress assembleFace(std::size_t e, const FabricState& state, const PredictedMotion* prediction, Local& at) const;
    std::array<Vec3, 2> expectedMoves(std::size_t e, const Local& at, const PredictedMotion& prediction) const;
    bool isSignificant(std::size_t e, const Local& at, const Stress& found, const std::array<Vec3, 2>& moves,
                       const PredictedMotion& prediction) const;

    std::size_t edges_ = 0;
    std::vector<std::array<int, 3>> corners_;
    std::vector<std::array<double, 3>> shares_;
    std::vector<int> incidenceBegin_, incidence_;
    std::vector<ContactModuli> moduli_;  ///< moduli of each material
    std::vector<int> material_;          ///< material of each element
    std::vector<double> volume_;         ///< packing factor times rest envelope volume [cm^3]
    std::vector<double> mass_;           ///< mass of each vertex when dry [g]
    std::vector<Local> local_;
    std::vector<Stress> stress_;
    std::vector<int> active_;
};

}  // namespace sim
