#include "sim/fabric/shells/shell_rest.h"

#include "sim/core/check.h"
#include "sim/fabric/shells/shells.h"

#include <fmt/format.h>

#include <map>

namespace sim {

namespace {

using Vec2 = Eigen::Vector2d;

double dihedralAngle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3)
{
    const Dihedral<double> d = dihedral(toVec3T(x0), toVec3T(x1), toVec3T(x2), toVec3T(x3));
    return angleOf(d.sine, d.cosine);
}

double areaOf(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).norm(); }

/// What an angle of 1 at edge k adds to the triangle's shape operator [1/cm].
Eigen::Matrix2d shapeOfEdge(const std::array<Vec2, 3>& corner, int k, double area)
{
    const Vec2 along = corner[(k + 2) % 3] - corner[(k + 1) % 3], out(along.y(), -along.x());
    return out * out.transpose() / (2.0 * area * along.norm());
}

/// Numbers 11, 22, 66 and 12 of a sheet whose axes are warp and weft (fabric/shells/README.md, Warp and weft).
using SheetLaw = std::array<double, 4>;

SheetLaw stretchLaw(const FabricMaterial& m)
{
    const auto& [warp, weft] = m.stretchStiffness;
    const double mean = std::sqrt(warp * weft), perPlane = 1.0 / (1.0 - m.poisson * m.poisson);
    const double shear = m.shearStiffness > 0.0 ? m.shearStiffness : mean / (2.0 * (1.0 + m.poisson));
    return {perPlane * warp, perPlane * weft, shear, perPlane * m.poisson * mean};
}

SheetLaw bendingLaw(const FabricMaterial& m)
{
    const auto& [warp, weft] = m.bendingStiffness;
    const double mean = std::sqrt(warp * weft);
    return {warp, weft, 0.5 * (1.0 - m.poisson) * mean, m.poisson * mean};
}

SheetLaw isotropicLaw(double modulus, double poisson)
{
    const double c11 = modulus / (1.0 - poisson * poisson);
    return {c11, c11, 0.5 * (1.0 - poisson) * c11, poisson * c11};
}

/// Turns the triangle in its plane such that the first axis is the warp.
void turnToWarp(std::array<Vec2, 3>& corner, const Vec2& warp)
{
    const Vec2 first = warp.normalized(), second(-first.y(), first.x());
    for (Vec2& p : corner) p = Vec2(first.dot(p), second.dot(p));
}

/// Q of the triangle-averaged shape operator by the curvatures along and across the warp (fabric/shells/README.md, Warp and weft).
std::array<double, 6> wovenShapeOperator(const std::array<Vec2, 3>& corner, double area, const SheetLaw& law)
{
    std::array<Eigen::Matrix2d, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = shapeOfEdge(corner, k, area);
    const auto entry = [&](int i, int j) {
        const Eigen::Matrix2d &a = q[i], &b = q[j];
        return area * (law[0] * a(0, 0) * b(0, 0) + law[1] * a(1, 1) * b(1, 1) + 4.0 * law[2] * a(0, 1) * b(0, 1) +
                       law[3] * (a(0, 0) * b(1, 1) + a(1, 1) * b(0, 0)));
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

/// Q of the triangle-averaged shape operator (fabric/shells/README.md, Bending).
std::array<double, 6> shapeOperator(const std::array<Vec2, 3>& corner, double area, double plate, double poisson)
{
    std::array<Eigen::Matrix2d, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = shapeOfEdge(corner, k, area);
    const auto entry = [&](int i, int j) {
        return area * plate * ((1.0 - poisson) * q[i].cwiseProduct(q[j]).sum() + poisson * q[i].trace() * q[j].trace());
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

/// The triangle laid into the plane: corner 0 at the origin, corner 1 on the first axis, or turned to the warp where there is one.
std::array<Vec2, 3> laidFlat(const std::array<Vec3, 3>& x, const Vec3* warp)
{
    const Vec3 first = (x[1] - x[0]).normalized();
    const double along = first.dot(x[2] - x[0]);
    const Vec3 up = x[2] - x[0] - along * first;
    std::array<Vec2, 3> flat = {Vec2(0.0, 0.0), Vec2((x[1] - x[0]).norm(), 0.0), Vec2(along, up.norm())};
    if (warp) turnToWarp(flat, Vec2(warp->dot(first), warp->dot(up.normalized())));
    return flat;
}

/// @param plate  of cloth that is alike in all directions [dyn cm]
std::array<double, 6> bendingOf(const FabricMaterial& material, const std::array<Vec2, 3>& flat, double area, double plate)
{
    const bool isWoven = material.bendingStiffness[0] > 0.0;
    return isWoven ? wovenShapeOperator(flat, area, bendingLaw(material)) : shapeOperator(flat, area, plate, material.poisson);
}

void setMembrane(const FabricMaterial& material, double thickness, double area, ShellRest<double>& rest)
{
    rest.young = material.young * thickness;
    rest.poisson = material.poisson;
    const bool isWoven = material.stretchStiffness[0] > 0.0;
    rest.area = isWoven ? area : material.packing() * area;
    rest.stretching = isWoven ? stretchLaw(material) : isotropicLaw(rest.young, material.poisson);
}

}  // namespace

ShellRest<double> shellRest(const Fabric& fabric, int face, const std::array<int, 3>& across, const FabricSettings& settings)
{
    const int number = fabric.faces.material[face];
    const FabricMaterial& material = fabric.materials[number];
    const Vec3i& corners = fabric.faces.vertices[face];
    const double thickness = fabric.faces.thickness[face], nu = material.poisson;
    std::array<Vec3, 3> x;
    for (int k = 0; k < 3; ++k) x[k] = fabric.rest[corners[k]];
    const std::array<Vec2, 3> flat = laidFlat(x, material.hasWarp() ? &fabric.warp[number] : nullptr);
    const double area = 0.5 * (flat[1].x() * flat[2].y() - flat[1].y() * flat[2].x());

    ShellRest<double> rest{};
    for (int k = 0; k < 3; ++k) {
        const Vec2 &p = flat[(k + 1) % 3], &q = flat[(k + 2) % 3];
        rest.ru[k] = (p.y() - q.y()) / (2.0 * area);
        rest.rw[k] = (q.x() - p.x()) / (2.0 * area);
    }
    setMembrane(material, thickness, area, rest);
    const double plate = material.packing() * material.young * thickness * thickness * thickness / (12.0 * (1.0 - nu * nu));
    for (int k = 0; k < 3; ++k) {
        if (across[k] < 0) continue;
        const Vec3 &x1 = x[(k + 1) % 3], &x2 = x[(k + 2) % 3], &x3 = fabric.rest[across[k]];
        rest.hasNeighbor[k] = 1.0;
        rest.angle[k] = dihedralAngle(x[k], x1, x2, x3);
        if (settings.bending == BendingModel::Hinge) {
            // k (Φ − Φ̄)² of the edge, half of it from either side (fabric/shells/README.md, Hinges).
            rest.bending[k] = 0.5 * plate * settings.hingeConstant * (x2 - x1).squaredNorm() / (area + areaOf(x1, x2, x3));
        }
    }
    if (settings.bending == BendingModel::ShapeOperator) rest.bending = bendingOf(material, flat, area, plate);
    return rest;
}

void setLane(ShellRest<Pack>& rest, int lane, const ShellRest<double>& one)
{
    for (int k = 0; k < 3; ++k) {
        rest.ru[k][lane] = one.ru[k];
        rest.rw[k][lane] = one.rw[k];
        rest.hasNeighbor[k][lane] = one.hasNeighbor[k];
        rest.angle[k][lane] = one.angle[k];
    }
    rest.area[lane] = one.area;
    rest.young[lane] = one.young;
    rest.poisson[lane] = one.poisson;
    for (int k = 0; k < 4; ++k) rest.stretching[k][lane] = one.stretching[k];
    for (int k = 0; k < 6; ++k) rest.bending[k][lane] = one.bending[k];
}

std::vector<std::array<int, 3>> verticesAcross(std::span<const Vec3i> faces)
{
    struct Side {
        int face, corner;
    };
    std::map<std::pair<int, int>, Side> sides;  // by the directed edge
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const std::pair edge(faces[f][(k + 1) % 3], faces[f][(k + 2) % 3]);
            if (!sides.emplace(edge, Side{f, k}).second)
                throw InputError(
                    fmt::format("cloth: the edge between vertices {} and {} has two faces of one orientation, or more than "
                                "two; orient all faces alike",
                                edge.first, edge.second));
        }
    std::vector<std::array<int, 3>> across(faces.size(), {-1, -1, -1});
    for (const auto& [edge, side] : sides) {
        const auto other = sides.find({edge.second, edge.first});
        if (other != sides.end()) across[side.face][side.corner] = faces[other->second.face][other->second.corner];
    }
    return across;
}

}  // namespace sim
