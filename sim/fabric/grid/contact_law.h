#pragma once

#include "sim/core/types.h"
#include "sim/fabric/pieces/piece.h"

#include <Eigen/Core>

namespace sim {

// Contact of fabric on the grid as an anisotropic continuum (fabric/grid/README.md, Contact law; after Jiang, Gast and Teran
// 2017): what its material directions d2, d3 (yarns) or d3 (cloth) do across a yarn or a sheet. They are looked at in a
// right-handed frame Q that goes with the mesh: q1 along a yarn, q3 normal to a face. Only compression acts.

/// Parameters of contact: Lamé parameters [dyn/cm^2], and friction.
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
/// Fraction of the shear stress at r that friction can hold [0..1].
double stickFraction(const ContactModuli& m, const Vec3& r);
/// Return mapping: r after separation and frictional slip.
Vec3 returnMapping(const ContactModuli& m, const Vec3& r);
/// r with its strain scaled by `share`, whose energy is at most share² of that of r.
Vec3 scaledStrain(const Vec3& r, double share);

}  // namespace sheet

/// Contact across a yarn, of R = Qᵀ (d2 d3): row 0 is shear along the yarn (r12, r13), rows 1 and 2 the deformation B
/// of the section.
namespace yarn {

using Strain = Eigen::Matrix<double, 3, 2>;
using SectionStiffness = Eigen::Matrix4d;  ///< second derivatives by the entries b00, b10, b01, b11 of B

/// q1 along the edge, q2 in the plane of q1 and d2.
Mat3 frameOf(const Vec3& along, const Vec3& d2);

/// Signed singular values of B = U diag(σ) Vᵀ with rotations U and V: |σ1| is the larger, det B = σ1 σ2.
struct Section {
    explicit Section(const Eigen::Matrix2d& b);
    Eigen::Matrix2d u, vt;
    Eigen::Vector2d sigma;
    Eigen::Vector2d log;  ///< logarithm of σ, which counts as kLeastThickness if it is less
};
inline Section sectionOf(const Strain& r) { return Section(r.bottomRows<2>()); }

// Of R with its section, which is most of the work.
double energy(const ContactModuli& m, const Strain& r, const Section& section);
Strain stress(const ContactModuli& m, const Strain& r, const Section& section);
/// ∂²ψ/∂B² with its negative eigenvalues set to 0; that by row 0 is `m.shear` where this is not zero. False, and 0,
/// without compression.
bool stiffness(const ContactModuli& m, const Section& section, SectionStiffness& k);

/// Fractions that friction can hold [0..1]: of the shear along the yarn, and of the deviatoric part of log σ.
struct StickFractions {
    double along = 1.0, across = 1.0;
};
StickFractions stickFraction(const ContactModuli& m, const Strain& r, const Section& section);
/// Section at the onset of contact on the way from an uncompressed one to `last`, or one without contact if there is none.
Section onsetOfContact(const Section& section, const Section& last);
/// The section with the deviatoric part of its log σ scaled by `across`.
Section withDeviatoric(const Section& section, double across);
/// Scales the part of K by `across` that does not respond to scaling the whole section.
void scaleDeviatoric(const Section& section, double across, SectionStiffness& k);
Strain returnMapping(const ContactModuli& m, const Strain& r);
/// R with its shear and its log σ scaled by `share`, whose energy is share² of that of R.
Strain scaledStrain(const Strain& r, double share);

}  // namespace yarn

}  // namespace sim
