#pragma once

#include "render/gl.h"

#include <filesystem>
#include <string>
#include <vector>

namespace render {

/// A name OpenGL gave out, given back on destruction (its context must be current then).
template <auto generate, auto release>
class GlName {
 public:
    explicit GlName(const Gl& gl) : gl_(&gl) { (gl.*generate)(1, &id_); }
    ~GlName() { (gl_->*release)(1, &id_); }
    GlName(const GlName&) = delete;
    GlName& operator=(const GlName&) = delete;
    GLuint id() const { return id_; }

 private:
    const Gl* gl_;
    GLuint id_ = 0;
};

using Buffer = GlName<&Gl::GenBuffers, &Gl::DeleteBuffers>;
using VertexArray = GlName<&Gl::GenVertexArrays, &Gl::DeleteVertexArrays>;
using Texture = GlName<&Gl::GenTextures, &Gl::DeleteTextures>;
using Renderbuffer = GlName<&Gl::GenRenderbuffers, &Gl::DeleteRenderbuffers>;
using Framebuffer = GlName<&Gl::GenFramebuffers, &Gl::DeleteFramebuffers>;

/// Describe attribute `index` as `count` floats of the struct in the bound buffer, `offset` bytes in.
void describeAttribute(const Gl& gl, GLuint index, int count, std::size_t stride, std::size_t offset);
/// Describe attribute `index` as four bytes that the shader sees as 0 … 1.
void describeColorAttribute(const Gl& gl, GLuint index, std::size_t stride, std::size_t offset);

/// Fill the buffer, for one picture.
template <class T>
void upload(const Gl& gl, GLenum target, const Buffer& buffer, const std::vector<T>& data)
{
    gl.BindBuffer(target, buffer.id());
    gl.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

/// Set up for closed bodies that face outwards: nearest in front, backs left out. The caller disables GL_CULL_FACE
/// afterwards.
void drawOpaque(const Gl& gl);

/// A linked pair of shaders, <name>.vert and <name>.frag of one folder, which may include others of it.
class Program {
 public:
    /// @param defined  a word that the shaders may ask for by #ifdef; empty: none
    /// Throws std::runtime_error with one line naming the file if it is missing or does not compile.
    Program(const Gl& gl, const std::filesystem::path& shaderDir, const std::string& name, const std::string& defined = {});
    ~Program() { gl_->DeleteProgram(id_); }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void use() const { gl_->UseProgram(id_); }
    /// Where the uniform lives; −1 (which OpenGL ignores) if the shader does not use it.
    GLint operator[](const char* uniform) const { return gl_->GetUniformLocation(id_, uniform); }

 private:
    const Gl* gl_;
    GLuint id_ = 0;
};

/// The folder with the shaders: `wanted` if not empty, else $DRENCH_SHADER_DIR, else the source tree this was built
/// from, else share/drench/shaders beside the folder of the running program.
/// Throws std::runtime_error naming the places looked at if none holds them.
std::filesystem::path findShaderDir(const std::filesystem::path& wanted = {});

}  // namespace render
