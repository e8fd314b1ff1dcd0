#pragma once

#include <GL/glcorearb.h>

#include <functional>

// Exactly the OpenGL 3.3 core functions the renderer uses, loaded at run time. One line here adds a function.
#define RENDER_GL_FUNCTIONS(X)                                                 \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                                   \
    X(PFNGLATTACHSHADERPROC, AttachShader)                                     \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                                         \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                               \
    X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)                             \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                                       \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                               \
    X(PFNGLBLENDFUNCPROC, BlendFunc)                                           \
    X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer)                               \
    X(PFNGLBUFFERDATAPROC, BufferData)                                         \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)                 \
    X(PFNGLCLEARPROC, Clear)                                                   \
    X(PFNGLCLEARCOLORPROC, ClearColor)                                         \
    X(PFNGLCOLORMASKPROC, ColorMask)                                           \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                                   \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                                   \
    X(PFNGLCREATESHADERPROC, CreateShader)                                     \
    X(PFNGLCULLFACEPROC, CullFace)                                             \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                   \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                         \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                                   \
    X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)                       \
    X(PFNGLDELETESHADERPROC, DeleteShader)                                     \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                                 \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                         \
    X(PFNGLDEPTHFUNCPROC, DepthFunc)                                           \
    X(PFNGLDEPTHMASKPROC, DepthMask)                                           \
    X(PFNGLDISABLEPROC, Disable)                                               \
    X(PFNGLDISABLEVERTEXATTRIBARRAYPROC, DisableVertexAttribArray)             \
    X(PFNGLDRAWARRAYSPROC, DrawArrays)                                         \
    X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)                       \
    X(PFNGLDRAWELEMENTSPROC, DrawElements)                                     \
    X(PFNGLENABLEPROC, Enable)                                                 \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray)               \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer)               \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)                     \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                                         \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                               \
    X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)                             \
    X(PFNGLGENTEXTURESPROC, GenTextures)                                       \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                               \
    X(PFNGLFINISHPROC, Finish)                                                 \
    X(PFNGLGETERRORPROC, GetError)                                             \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                                       \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                           \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                     \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                             \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                                       \
    X(PFNGLGETSTRINGPROC, GetString)                                           \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)                         \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                                       \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                                       \
    X(PFNGLREADBUFFERPROC, ReadBuffer)                                         \
    X(PFNGLREADPIXELSPROC, ReadPixels)                                         \
    X(PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC, RenderbufferStorageMultisample) \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                                     \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                                         \
    X(PFNGLTEXPARAMETERIPROC, TexParameteri)                                   \
    X(PFNGLUNIFORM1FPROC, Uniform1f)                                           \
    X(PFNGLUNIFORM1IPROC, Uniform1i)                                           \
    X(PFNGLUNIFORM2FPROC, Uniform2f)                                           \
    X(PFNGLUNIFORM3FPROC, Uniform3f)                                           \
    X(PFNGLUNIFORM4FPROC, Uniform4f)                                           \
    X(PFNGLUNIFORMMATRIX4FVPROC, UniformMatrix4fv)                             \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                                         \
    X(PFNGLVERTEXATTRIB1FPROC, VertexAttrib1f)                                 \
    X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)                       \
    X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)                       \
    X(PFNGLVIEWPORTPROC, Viewport)

namespace render {

/// The functions of one OpenGL context: gl.DrawArrays(...) is glDrawArrays(...).
struct Gl {
#define RENDER_GL_MEMBER(type, name) type name = nullptr;
    RENDER_GL_FUNCTIONS(RENDER_GL_MEMBER)
#undef RENDER_GL_MEMBER
};

/// Ask the context for every function of the table. Throws std::runtime_error naming the first one that is missing.
Gl loadGl(const std::function<void*(const char*)>& getProcAddress);

/// "invalid operation" and the like.
const char* glErrorName(GLenum error);

/// Throws std::runtime_error "OpenGL: <reason> while <doing>" if an error is pending.
void requireNoGlError(const Gl& gl, const char* doing);

}  // namespace render
