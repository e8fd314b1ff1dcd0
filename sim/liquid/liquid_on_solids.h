#pragma once

#include "sim/core/chunk_sums.h"
#include "sim/forces.h"
#include "sim/liquid/pressure.h"
#include "sim/liquid/strain_correction.h"
#include "sim/liquid/viscous_system.h"

#include <vector>

namespace sim {

/// What each solid gets of the liquid's momentum on the grid in a step. On a face that no solid is near, all that changes the liquid's momentum
/// beside weight and fabric is the step of the pressure, −K (p above − p below) with the same K everywhere, and the step of viscous stresses; both
/// sum up to nothing over all faces. So what a face near a solid has got beyond them is from the solid: the pressure on what it closes of the cell,
/// what its wall takes from what particles bring behind it, and its share of a face that is not open all the way. It is the nearest solid's,
/// and acts in the middle of the face. Not from the solid is what pressure does to a face that is less full than it counts (findPressureFaces).
class LiquidOnSolids {
 public:
    /// After P2G: what particles have brought to faces near solids, before weight, walls and forces act there.
    void begin(const CutGrid& cut, const FaceFields& faces);
    /// Token that velocities are kept which something is going to change. Holds until the next call of keepVelocities.
    class KeptVelocities {
        friend LiquidOnSolids;
        KeptVelocities() = default;
    };
    KeptVelocities keepVelocities(const BlockArray<double, 3>& velocity);
    /// After the solve for viscosity: of its stresses solids get those on closed faces and on walls that stick.
    /// @return  work that those of them which move did on the liquid by it [erg]
    double afterViscosity(const KeptVelocities&, const CutGrid& cut, const ViscousSystem& system, const LiquidGrid& liquid);
    /// After the strain correction: solids receive the impulse of the closed faces.
    void afterStrain(const KeptVelocities&, const CutGrid& cut, const StrainWorkspace& strain, const LiquidGrid& liquid);
    /// Told, while weight is moved between faces, by how much that of each grew [g cm/s].
    class Levelling {
     public:
        void weightGrew(int block, int axis, int cell, double impulse) const
        {
            if (const int place = of_->place_[block]; place != BlockGrid::kNone) of_->others_.block(place, axis)[cell] += impulse;
        }

     private:
        friend LiquidOnSolids;
        explicit Levelling(LiquidOnSolids& of) : of_(&of) {}
        LiquidOnSolids* of_;
    };
    Levelling meetLevelling();
    /// Told, where there is fabric on faces, what fabric and suction took from the liquid of each [g cm/s].
    class Exchange {
     public:
        void fabricTook(int block, int axis, int cell, double impulse) const
        {
            const int place = of_->place_[block];
            if (place == BlockGrid::kNone) return;
            of_->others_.block(place, axis)[cell] -= impulse;
            of_->shared_.set(place, cell, axis);
        }

     private:
        friend LiquidOnSolids;
        explicit Exchange(LiquidOnSolids& of) : of_(&of) {}
        LiquidOnSolids* of_;
    };
    Exchange meetFabric();

    /// What acted on the faces of which particles then read their momentum.
    struct Outcome {
        const BlockArray<double, 3>& velocity;  ///< velocities that particles read [cm/s]
        const LiquidGrid& liquid;
        const PressureFaces& system;
        const BlockArray<double>& pressure;         ///< [dyn/cm^2]
        const BlockArray<double>* again;            ///< pressure of a reflection, or null [dyn/cm^2]
        const BlockArray<double, 3>* flipVelocity;  ///< velocities after P2G, FLIP only; else null [cm/s]
        double flipRatio;                           ///< FLIP ratio [-]
        double perPressure;                         ///< K: of a face amid liquid by the step of the pressure [cm^2 s]
        Vec3 fall;                                  ///< what weight made of velocities [cm/s]
    };
    void finish(const CutGrid& cut, const Outcome& outcome);

    /// What a solid got, and of that what pressed on the closed part of its faces, regardless of direction, and where that is.
    struct OnSolid {
        Impulse impulse;
        double pressed = 0.0;        ///< [g cm/s]
        Vec3 moment = Vec3::Zero();  ///< moment of `pressed` [g cm^2/s]
        double work = 0.0;           ///< work of the solid, if it moves, on the liquid [erg]
        OnSolid& operator+=(const OnSolid& other)
        {
            impulse += other.impulse;
            pressed += other.pressed;
            moment += other.moment;
            work += other.work;
            return *this;
        }
    };
    OnSolid on(int solid) const { return sums_.sum(solid); }

 private:
    static constexpr int kMass = 0, kMomentum = 3;  ///< kinds of brought_
    /// Eight faces in a row along x, of a block near solids.
    struct FaceRow {
        std::size_t place;  ///< place of the block
        int axis, first;    ///< axis to which they are normal; the first of them in the block
    };
    /// What the faces of a row got of solids, how hard these press on what they close, and what the pressure would give to a closed face.
    struct GotByRow {
        Pack got, pressed, push;  ///< [g cm/s]
    };
    void clearOthers();
    std::uint64_t facesNear(const BitAccess& bits, int block, int axis, int k) const { return near_.block(block)[k] | bits.below(near_, 0, axis, k); }
    std::uint64_t wetNear(const BitAccess& bits, const Outcome& outcome, std::size_t place, int axis, int k) const;
    Pack stepOf(const CutGrid& cut, const Outcome& outcome, const FaceRow& row) const;
    GotByRow onRow(const CutGrid& cut, const Outcome& outcome, const FaceRow& row) const;
    void addShared(const CutGrid& cut, const FaceRow& row, int lane, const Vec3& at, const GotByRow& on, std::span<OnSolid> sums) const;
    void addRow(const CutGrid& cut, const FaceRow& row, unsigned faces, const GotByRow& on, std::span<OnSolid> sums) const;
    void finishBlock(const CutGrid& cut, const Outcome& outcome, std::size_t place, std::span<OnSolid> sums) const;

    int solids_ = 0;
    std::vector<int> blocks_, place_;  ///< blocks near solids; each block's place among them, or BlockGrid::kNone
    BlockBits<> near_;                 ///< cells whose middles are near a solid
    // By place, of rows with faces near one:
    BlockArray<double, 6> brought_;  ///< mass [g] and momentum [g cm/s] that particles brought to each face
    BlockArray<double, 3>
        others_;  ///< momentum that a face got of viscous stresses, of the strain correction and of levelled weight, less what fabric took [g cm/s]
    BlockBits<3> shared_;           ///< faces that fabric is on
    bool hasOthers_ = false;        ///< whether others_ and shared_ hold anything in this step
    BlockArray<double, 3> before_;  ///< KeptVelocities [cm/s]
    ChunkSums<OnSolid> sums_;
};

}  // namespace sim
