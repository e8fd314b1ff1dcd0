#include "app/system/gnuplot.h"

#include "app/system/atomic_files.h"
#include "app/system/child_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace app {

bool canPlot() { return findProgram("gnuplot").has_value(); }

std::string gnuplotText(std::string text)
{
    for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 2) text.insert(at, 1, '\'');
    return '\'' + text + '\'';
}

std::string gnuplotUnit(const std::string& unit)
{
    constexpr std::string_view kExponent = "-0123456789", kSpecial = "_@&~{}\\";
    std::string text = "[";
    for (std::size_t at = 0; at < unit.size(); ++at) {
        const std::size_t end = unit[at] == '^' ? std::min(unit.find_first_not_of(kExponent, at + 1), unit.size()) : at;
        if (end > at + 1) {
            text += fmt::format("^{{{}}}", unit.substr(at + 1, end - at - 1));
            at = end - 1;
        } else {
            if (kSpecial.find(unit[at]) != std::string_view::npos) text += '\\';
            text += unit[at];
        }
    }
    return gnuplotText(text + ']');
}

void drawPlot(const std::filesystem::path& folder, const std::string& name, const std::function<std::string(const std::string& picture)>& script)
{
    const auto program = findProgram("gnuplot");
    if (!program) throw std::runtime_error("no gnuplot along PATH: install it to get plots");
    const std::string picture = name + ".png", text = name + ".gp";
    writeWhole(folder / text, script(picture));

    const auto part = partFile(picture);
    writeWhole(folder / (text + ".part"), script(part.string()));
    const ChildExit end = runChild(*program, {text + ".part"}, {.folder = folder});
    std::filesystem::remove(folder / (text + ".part"));
    if (!end.ok()) throw std::runtime_error(fmt::format("gnuplot could not draw {}: {}", (folder / picture).string(), end.lastWords()));
    putInPlace(folder / part, folder / picture);
}

}  // namespace app
