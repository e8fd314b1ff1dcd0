#pragma once

#include "sim/grid/face_fields.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"
#include "sim/settings.h"

namespace sim {

/// Does P2G by this map differ from the plain translation of particlesToFaces? Not without a gradient; and with a
/// gradient alone, affine_conservative puts back all that the map changes.
/// @param modes  N_r
bool differsFromTranslation(XiMap map, int modes);

/// P2G as particlesToFaces does it, with the particles' polynomials carried by their own linear motion since they were
/// gathered (transfer/README.md, Maps): face i receives U(A (x_i − x_p)), A = (I + dt C)⁻¹ with the linear modes as rows of C.
/// AffineConservative then restores the weighted mean and gradient that were gathered, so that both momenta are exact.
/// Where det(I + dt C) < 0.1 the polynomial is only translated.
/// @param dt  time for which the particles have moved with their mean velocity since their modes were gathered [s]
void particlesToFacesAffine(const SortedParticles& sorted, XiMap map, double dt, FaceFields& faces);

}  // namespace sim
