#pragma once

#include <string>
#include <vector>

namespace app {

/// A truth value as YAML has it.
inline const char* yesOrNo(bool holds) { return holds ? "true" : "false"; }

/// The lines of a scene file that is being written, each with the line of the XML that it comes from.
class SceneLines {
 public:
    /// What follows comes from this line, until another is told.
    void from(int xmlLine) { xmlLine_ = xmlLine; }
    /// One line, `depth` levels in; one that is too long goes on behind commas.
    void add(int depth, const std::string& text);
    void blank() { put(""); }

    std::string text() const;
    /// The line of the XML behind a line of the scene, both counted from 1.
    int xmlLine(int line) const;

 private:
    void put(std::string line);

    std::vector<std::string> lines_;
    std::vector<int> xmlLines_;
    int xmlLine_ = 1;
};

}  // namespace app
