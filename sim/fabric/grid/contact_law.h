#pragma once

#include "sim/core/types.h"
#include "sim/fabric/pieces/piece.h"

#include <Eigen/Core>

namespace sim {

// Contact of fabric on the grid as an anisotropic continuum (fabric/grid/README.md, Contact law; after Jiang, Gast and Teran
// 2017): what its material directions d2, d3 (yarns) or d3 (cloth) do across a yarn or a sheet. They are looked at in a
// right-handed frame Q that goes with the mesh: q1 along a yarn, q3 normal to a face. Only compression acts.

/// Of contact: Lamé parameters [dyn/cm^2], and friction.
struct ContactModuli {
    ContactModuli() = default;
    explicit ContactModuli(const FabricMaterial& material);

    double normal() const { return 2.0 * shear + lame; }

    double shear = 0.0, lame = 0.0;  ///< μ_c, λ_c
    double cone = 0.0;               ///< α of Drucker and Prager: √(2/3) 2 sin φ / (3 − sin φ) [-]
    double coulomb = 0.0;            ///< β = tan φ [-]
};

/// What is at least left of a thickness: strains of what was turned inside out come back to it [-].
inline constexpr double kLeastThickness = 0.05;

/// Compression below which there is none: after separation round-off is left, and a stiffness that acts both ways would
/// hold together what parts [-].
inline constexpr double kLeastCompression = 1.0e-9;

/// Contact across a sheet, of r = (r13, r23, r33) = Qᵀ d3. r33 has the sign of the side of the face that d3 is on, so
/// that d3 is pushed back from the wrong one.
namespace sheet {

/// q1 along t0, q3 along t0 × t1. @param t0, t1  edges of the face from its first vertex [cm]
Mat3 frameOf(const Vec3& t0, const Vec3& t1);

/// ψ: energy per rest envelope volume [erg/cm^3].
double energy(const ContactModuli& m, const Vec3& r);
/// ∂ψ/∂r [dyn/cm^2].
Vec3 stress(const ContactModuli& m, const Vec3& r);
/// Diagonal of ∂²ψ/∂r², which has nothing beside it and nothing negative; where it is pressed harder at `last`, of the chord to there, as what
/// only comes to touch would else be pressed for a step without any resistance [dyn/cm^2].
Vec3 stiffness(const ContactModuli& m, const Vec3& r, const Vec3& last);
/// Share of the shear stress at r that friction holds [0..1].
double held(const ContactModuli& m, const Vec3& r);
/// r after separation and friction.
Vec3 returned(const ContactModuli& m, const Vec3& r);
/// r with a share of its strain, which has at most the square of that share of its energy.
Vec3 eased(const Vec3& r, double share);

}  // namespace sheet

/// Contact across a yarn, of R = Qᵀ (d2 d3): row 0 is shear along the yarn (r12, r13), rows 1 and 2 the deformation B
/// of the section.
namespace yarn {

using Strain = Eigen::Matrix<double, 3, 2>;
using SectionStiffness = Eigen::Matrix4d;  ///< by the entries b00, b10, b01, b11 of B

/// q1 along the edge, q2 in the plane of q1 and d2.
Mat3 frameOf(const Vec3& along, const Vec3& d2);

/// Signed singular values of B = U diag(σ) Vᵀ with rotations U and V: |σ1| is the larger, det B = σ1 σ2.
struct Section {
    explicit Section(const Eigen::Matrix2d& b);
    Eigen::Matrix2d u, vt;
    Eigen::Vector2d sigma;
    Eigen::Vector2d log;  ///< of σ, which counts as kLeastThickness if it is less
};
inline Section sectionOf(const Strain& r) { return Section(r.bottomRows<2>()); }

// Of R with its section, which is most of the work.
double energy(const ContactModuli& m, const Strain& r, const Section& section);
Strain stress(const ContactModuli& m, const Strain& r, const Section& section);
/// ∂²ψ/∂B² with its negative eigenvalues set to 0; that by row 0 is `m.shear` where this is not zero. False, and 0,
/// without compression.
bool stiffness(const ContactModuli& m, const Section& section, SectionStiffness& k);

/// Shares that friction holds [0..1]: of the shear along the yarn, and of what makes log σ1 and log σ2 differ.
struct Held {
    double along = 1.0, across = 1.0;
};
Held held(const ContactModuli& m, const Strain& r, const Section& section);
/// An unpressed section when it comes to touch, if it does on its way to the last; else one that does not.
Section touching(const Section& section, const Section& last);
/// The section with `across` of the difference of its log σ.
Section slid(const Section& section, double across);
/// Leaves `across` of what K has beside the answer to scaling the whole section.
void slide(const Section& section, double across, SectionStiffness& k);
Strain returned(const ContactModuli& m, const Strain& r);
/// R with a share of its strain and of log σ, which has the square of that share of its energy.
Strain eased(const Strain& r, double share);

}  // namespace yarn

}  // namespace sim
