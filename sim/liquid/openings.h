#pragma once

#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/pressure.h"
#include "sim/opening_settings.h"

#include <Eigen/Geometry>

#include <optional>
#include <span>
#include <vector>

namespace sim {

/// Faces of the domain that liquid passes (liquid/README.md, Faces of the domain). The last two to three cells of the domain are beyond the opening's
/// plane, a plane of faces: there is no pressure there, and no air. An inlet drives all faces there and in its plane; at an outlet the liquid beyond
/// presses on the plane, and the faces there move as those of the plane do.
class Openings {
 public:
    static constexpr int kThickness = 2;  ///< least thickness of what is beyond the plane: as far as particles in front of it reach [cells]

    /// @param solids   where they are when the run begins
    /// @param gravity  [cm/s^2]
    void prepare(std::span<const OpeningSettings> openings, const Eigen::AlignedBox3d& domain, const Obstacles& solids, double dx,
                 const Vec3& gravity);
    bool empty() const { return sides_.empty(); }

    /// Finds which cells of the grid are beyond openings (LiquidGrid::beyond), and the faces there.
    void find(const BlockGrid& grid, LiquidGrid& liquid);
    /// No pressure acts on the plane of an inlet.
    void closeInlets(PressureFaces& faces) const;
    /// Openings hold liquid: takes their planes out.
    void takeHeld(BlockBits<3>& unheld) const;

    /// How liquid beyond outlets presses.
    struct Push {
        Vec3 gravity;     ///< [cm/s^2]
        double density;   ///< [g/cm^3]
        double fallTime;  ///< how long weight acts on velocities in the step [s]
        double dt;        ///< [s]
    };
    /// Inlets give their faces their velocity; at outlets the pressure of what is beyond acts on the plane. Before the projection.
    void drive(const CutGrid& cut, const Push& push, const PressureFaces& faces, std::span<const OpeningMemory> memory, LiquidGrid& liquid);
    /// The pressure has acted on velocities that are withheld from viscosity: what pushes there has done its work by then.
    void keepMoved(const BlockArray<double, 3>& velocity);
    struct Carried {
        double gained = 0.0;  ///< kinetic energy of the faces [erg]
        double held = 0.0;    ///< what weight had given to them and is not left [erg]
    };
    /// Velocities go on beyond outlets as in their planes.
    Carried carry(const CutGrid& cut, const LiquidGrid& liquid, BlockArray<double, 3>& velocity) const;
    /// Weight has acted for a time on the velocities of the faces, images behind walls have had theirs withheld, and nothing else: outlets find
    /// where walls keep weight from the pressure.
    /// @param fall  what weight makes of velocities [cm/s]
    void weigh(const LiquidGrid& liquid, const Vec3& fall);
    /// The slow mean of what goes out through each.
    /// @param gravity  [cm/s^2]
    void followMean(const LiquidGrid& liquid, double gravity, double dt, std::span<OpeningMemory> memory) const;

    /// Kinetic energy that the last drive() gave to faces of inlets [erg].
    double driven() const { return driven_; }
    /// Work of inlets in a step of viscosity, beyond what the next drive() has: they are driven before viscosity, which takes from their faces, and
    /// again after what they got has been withheld [erg].
    /// @param liquid    right after viscosity
    /// @param withheld  what will be added to its velocities
    double viscousWork(const CutGrid& cut, const LiquidGrid& liquid, const BlockArray<double, 3>& withheld) const;
    /// What weight had given to faces whose velocities are set, before the last drive(): nothing is left of it [erg].
    double heldWeight() const { return held_; }
    /// Work of the openings' pressure on the liquid [erg].
    /// @param perPressure  impulse on a face amid liquid by the step of the pressure [cm^2 s]
    double pressureWork(const CutGrid& cut, const LiquidGrid& liquid, const BlockArray<double>& pressure, double perPressure) const;
    /// The same of a pressure that acts beside that, as of a reflection: on inlets only.
    double inletWork(const CutGrid& cut, const LiquidGrid& liquid, const BlockArray<double>& pressure, double perPressure) const;

    /// What acted in a step on the faces of which particles then read their momentum.
    struct Outcome {
        const BlockArray<double, 3>& velocity;  ///< velocities that particles read [cm/s]
        const LiquidGrid& liquid;
        const BlockArray<double>& pressure;  ///< [dyn/cm^2]
        const BlockArray<double>* again;     ///< pressure of a reflection, or null [dyn/cm^2]
        double perPressure;                  ///< as of pressureWork
    };
    /// What openings gave to the liquid [g cm/s].
    /// @param onSolids  is told of it near solids, as it is not from them; may be null
    Vec3 impulse(const CutGrid& cut, const Outcome& outcome, const LiquidOnSolids::Levelling* onSolids) const;

    /// Exchanges velocities in the planes of inlets for those that are driven, and back after a reflection.
    void swapAtInlets(BlockArray<double, 3>& advected);

    /// The cells with a pressure in front of an inlet; none of an outlet.
    void findInletCells(const LiquidCells& cells, std::size_t opening, std::vector<InflowCell>& found) const;

 private:
    static constexpr int kNone = -1;
    struct Side {
        OpeningSettings opening;
        int plane = 0;                           ///< number of the plane of faces along the axis
        Vec3i low, high;                         ///< first and last cells beyond it
        double depth = 0.0;                      ///< outlet with air above its level: mean depth of the liquid there; else 0 [cm]
        std::size_t firstFace = 0, endFace = 0;  ///< of planeFaces_
        std::vector<int> faces;                  ///< by places in the plane: of planeFaces_, or kNone
    };
    /// A face in a plane, with the cells on its sides.
    struct PlaneFace {
        CellRef face, inner, over;         ///< the face, the cell in front of it, and the face on top of that cell, against gravity
        int above = kNone, below = kNone;  ///< the faces above and below it against gravity, of planeFaces_
        double missing = 0.0;              ///< pressure that walls keep from the cell, relative to that of one cell of liquid [-]
        double height;                     ///< of the middle of the outer cell against gravity [cm]
        double pushed = 0.0;               ///< change of its velocity by the pressure beyond an outlet [cm/s]
        std::optional<double> moved{};     ///< velocity at which that push does its work, if it is not the one in the end [cm/s]
        double kept = 0.0;                 ///< of swapAtInlets [cm/s]
    };
    /// A face beyond a plane, or in that of an inlet.
    struct DrivenFace {
        CellRef face;
        int axis;
        enum class By { Copy, Velocity, VelocityInAir } by;
        CellRef from;     ///< face that it moves like; of VelocityInAir the cell in front of it, which meets a wall if it has a pressure
        double velocity;  ///< that it is given, if it does not move like another [cm/s]
    };
    static bool isBeyond(const Side& side, const Vec3i& cell);
    bool isUnderLevel(const Side& side, const Vec3i& cell) const;
    void findPlane(const BlockGrid& grid, Side& side);
    void findDriven(const BlockGrid& grid, const Side& side, LiquidGrid& liquid);
    void addDriven(const BlockGrid& grid, const Side& side, const Vec3i& cell, int axis);
    void findDepth(const Obstacles& solids, const Eigen::AlignedBox3d& domain, Side& side) const;
    std::optional<double> meanOut(const Side& side, const LiquidGrid& liquid) const;
    int& faceAt(Side& side, const Vec3i& cell) const;
    void press(const CutGrid& cut, const Push& push, const PressureFaces& faces, const OpeningMemory& memory, const Side& side, LiquidGrid& liquid);
    static double velocityOf(const DrivenFace& driven, const LiquidGrid& liquid);

    std::vector<Side> sides_;
    std::vector<PlaneFace> planeFaces_;
    std::vector<DrivenFace> drivenFaces_;
    double dx_ = 0.0, driven_ = 0.0, held_ = 0.0;
    Vec3 up_ = Vec3::Zero();    ///< against gravity; 0 without
    Vec3 fall_ = Vec3::Zero();  ///< what weight made of velocities before the last drive() [cm/s]
};

}  // namespace sim
