#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// Total energy of a run less that of another, over time.
struct EnergyDifference {
    std::vector<double> times;    ///< [s]
    std::vector<double> percent;  ///< percent of the largest total energy of the other
};

/// One curve of the energy plot.
struct EnergyCurve {
    std::string variant;               ///< first column of the joined CSV
    std::string label;                 ///< name in the legend
    std::filesystem::path csv;         ///< an energy.csv as a run leaves it
    std::int64_t vertices = 0;         ///< number of vertices of fabric, which the paper counts with the particles
    EnergyDifference difference = {};  ///< difference to the first method of the scene; empty: none
};

/// One table of all curves, long form: the columns of energy.csv behind one that names the variant.
/// Throws std::runtime_error when a file cannot be read or written.
void joinEnergies(const std::vector<EnergyCurve>& curves, const std::filesystem::path& target);

/// The gnuplot program that draws kinetic, potential and total energy of all curves against time.
/// @param scale  the axis is in 10^scale erg
std::string energyPlotScript(const std::vector<EnergyCurve>& curves, int scale, const std::string& title, const std::string& picture);

/// Mean energy per particle as the paper draws it: all of it, and beside it what the published program takes for it; where curves have differences a
/// third panel shows them.
std::string perParticleScript(const std::vector<EnergyCurve>& curves, const std::string& title, const std::string& picture);

/// Draw folder/energy.png, and leave folder/energy.gp beside it to draw it anew with. Throws std::runtime_error with
/// gnuplot's own words.
void plotEnergies(const std::vector<EnergyCurve>& curves, const std::string& title, const std::filesystem::path& folder);

/// Draw energies per particle as folder/name.png, and differences of the totals beside them, and leave folder/name.gp.
void plotPerParticle(const std::vector<EnergyCurve>& curves, const std::string& title, const std::filesystem::path& folder, const std::string& name);

}  // namespace app
