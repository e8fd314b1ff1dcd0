#include "render/gl_objects.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace render {

namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path)
{
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    if (!file) throw std::runtime_error("cannot read shader " + path.string());
    return text.str();
}

/// The text of a shader, with other files of its folder in the place of lines `#include "lighting.glsl"`, and a word
/// defined below its first line, which tells the version.
std::string readShader(const fs::path& path, const std::string& defined)
{
    constexpr std::string_view kInclude = "#include \"";
    std::istringstream lines(readText(path));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        const bool isInclude = line.starts_with(kInclude) && line.back() == '"';
        text += isInclude ? readText(path.parent_path() / line.substr(kInclude.size(), line.size() - kInclude.size() - 1)) : line;
        text += '\n';
        if (line.starts_with("#version") && !defined.empty()) text += "#define " + defined + "\n";
    }
    return text;
}

/// What the driver says, on one line.
std::string oneLine(std::string log)
{
    while (!log.empty() && (log.back() == '\n' || log.back() == '\0')) log.pop_back();
    std::ranges::replace(log, '\n', ' ');
    return log;
}

/// A shader object for as long as the program is linked.
class Shader {
 public:
    Shader(const Gl& gl, GLenum stage, const fs::path& path, const std::string& defined) : gl_(gl), id_(gl.CreateShader(stage))
    {
        const std::string text = readShader(path, defined);
        const char* source = text.c_str();
        gl.ShaderSource(id_, 1, &source, nullptr);
        gl.CompileShader(id_);
        GLint compiled = GL_FALSE;
        gl.GetShaderiv(id_, GL_COMPILE_STATUS, &compiled);
        if (compiled) return;
        std::array<char, 1024> log{};
        gl.GetShaderInfoLog(id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
        gl.DeleteShader(id_);
        throw std::runtime_error("shader " + path.string() + " does not compile: " + oneLine(log.data()));
    }
    ~Shader() { gl_.DeleteShader(id_); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    GLuint id() const { return id_; }

 private:
    const Gl& gl_;
    GLuint id_;
};

}  // namespace

void describeAttribute(const Gl& gl, GLuint index, int count, std::size_t stride, std::size_t offset)
{
    gl.VertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride), reinterpret_cast<const void*>(offset));
    gl.EnableVertexAttribArray(index);
}

void describeColorAttribute(const Gl& gl, GLuint index, std::size_t stride, std::size_t offset)
{
    gl.VertexAttribPointer(index, 4, GL_UNSIGNED_BYTE, GL_TRUE, static_cast<GLsizei>(stride), reinterpret_cast<const void*>(offset));
    gl.EnableVertexAttribArray(index);
}

void drawOpaque(const Gl& gl)
{
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    gl.DepthMask(GL_TRUE);
    gl.Disable(GL_BLEND);
    gl.Enable(GL_CULL_FACE);
    gl.CullFace(GL_BACK);
}

Program::Program(const Gl& gl, const fs::path& shaderDir, const std::string& name, const std::string& defined) : gl_(&gl)
{
    const Shader vertex(gl, GL_VERTEX_SHADER, shaderDir / (name + ".vert"), defined);
    const Shader fragment(gl, GL_FRAGMENT_SHADER, shaderDir / (name + ".frag"), defined);
    id_ = gl.CreateProgram();
    gl.AttachShader(id_, vertex.id());
    gl.AttachShader(id_, fragment.id());
    gl.LinkProgram(id_);
    GLint linked = GL_FALSE;
    gl.GetProgramiv(id_, GL_LINK_STATUS, &linked);
    if (linked) return;
    std::array<char, 1024> log{};
    gl.GetProgramInfoLog(id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
    gl.DeleteProgram(id_);
    throw std::runtime_error("shaders " + (shaderDir / name).string() + " do not link: " + oneLine(log.data()));
}

fs::path findShaderDir(const fs::path& wanted)
{
    std::vector<fs::path> places;
    const char* fromEnvironment = std::getenv("DRENCH_SHADER_DIR");
    if (!wanted.empty()) {
        places = {wanted};
    } else if (fromEnvironment != nullptr && *fromEnvironment != '\0') {
        places = {fromEnvironment};
    } else {
        std::error_code noSuchLink;
        const fs::path program = fs::read_symlink("/proc/self/exe", noSuchLink);
        places = {RENDER_SHADER_SOURCE_DIR, program.parent_path().parent_path() / RENDER_SHADER_INSTALL_DIR};
    }
    std::string looked;
    for (const fs::path& place : places) {
        std::error_code unreadable;
        if (fs::exists(place / "liquid.vert", unreadable)) return place;
        looked += (looked.empty() ? "" : ", ") + place.string();
    }
    throw std::runtime_error("no shaders in " + looked + " (set DRENCH_SHADER_DIR to the folder that holds liquid.vert)");
}

}  // namespace render
