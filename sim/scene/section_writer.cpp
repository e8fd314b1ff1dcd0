#include "sim/scene/section_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {

std::string SectionWriter::take() const
{
    constexpr std::size_t kWidestAligned = 44;
    std::size_t column = 0;
    for (const Line& l : lines_) {
        if (l.text.size() <= kWidestAligned) column = std::max(column, l.text.size());
    }
    std::string out;
    for (const Line& l : lines_) {
        out += l.text;
        if (!l.comment.empty()) out += std::string(l.text.size() < column ? column - l.text.size() : 0, ' ') + "  # " + l.comment;
        out += '\n';
    }
    return out;
}

std::string SectionWriter::flow() const
{
    std::string out;
    for (const Line& l : lines_) out += (out.empty() ? "" : ", ") + l.text;
    return "{" + out + "}";
}

void SectionWriter::line(const std::string& key, const std::string& value, const std::string& comment)
{
    const std::string indentation(static_cast<std::size_t>(2 * depth_), ' ');
    lines_.push_back({indentation + key + (value.empty() ? ":" : ": ") + value, comment});
}

std::string SectionWriter::comment(Quantity quantity, const char* help)
{
    const std::string unit = unitOf(quantity);
    return unit.empty() ? help : fmt::format("[{}] {}", unit, help);
}

void SectionWriter::numbers(const char* key, std::span<double> values, Quantity quantity, const char* help)
{
    std::string list;
    for (const double x : values) list += (list.empty() ? "" : ", ") + formatNumber(x, quantity);
    line(key, "[" + list + "]", comment(quantity, help));
}

void SectionWriter::texts(const char* key, std::vector<std::string>& all, const char* help)
{
    if (all.empty()) return;
    Node list;
    list.kind = Node::Kind::List;
    for (const std::string& text : all) list.items.push_back(Node::scalar(text, {}));
    line(key, list.flow(), help);
}

void SectionWriter::color(const char* key, Eigen::Vector3f& x, const char* help) { line(key, fmt::format("[{}, {}, {}]", x[0], x[1], x[2]), help); }

void SectionWriter::flags(const char* key, std::initializer_list<NamedFlag> all, const char* help)
{
    std::string list;
    for (const NamedFlag& f : all) {
        if (*f.value) list += (list.empty() ? "" : ", ") + std::string(f.word);
    }
    line(key, "[" + list + "]", help);
}

}  // namespace sim
