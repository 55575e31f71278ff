/* gl.h: the table of OpenGL functions, filled when the context opens, and the check of GL's error flag.
 *
 * Call as gl.BindBuffer(...). What is newer than GL 3.3 is NULL where the context is older; test it before
 * use. glcorearb.h must come before osmesa.h: the latter's gl.h otherwise declares the same functions anew.
 */
#ifndef HARNESS_GL_H
#define HARNESS_GL_H

#include <GL/glcorearb.h>

/* In every context we accept: X(type, name). */
#define HN_GL_33(X)                                              \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                     \
    X(PFNGLATTACHSHADERPROC, AttachShader)                       \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                           \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                 \
    X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)               \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                         \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                 \
    X(PFNGLBLENDCOLORPROC, BlendColor)                           \
    X(PFNGLBLENDEQUATIONSEPARATEPROC, BlendEquationSeparate)     \
    X(PFNGLBLENDFUNCSEPARATEPROC, BlendFuncSeparate)             \
    X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer)                 \
    X(PFNGLBUFFERDATAPROC, BufferData)                           \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)   \
    X(PFNGLCLEARBUFFERFIPROC, ClearBufferfi)                     \
    X(PFNGLCLEARBUFFERFVPROC, ClearBufferfv)                     \
    X(PFNGLCOLORMASKPROC, ColorMask)                             \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                     \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                     \
    X(PFNGLCREATESHADERPROC, CreateShader)                       \
    X(PFNGLCULLFACEPROC, CullFace)                               \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                     \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)           \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                     \
    X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)         \
    X(PFNGLDELETESHADERPROC, DeleteShader)                       \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                   \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)           \
    X(PFNGLDEPTHFUNCPROC, DepthFunc)                             \
    X(PFNGLDEPTHMASKPROC, DepthMask)                             \
    X(PFNGLDISABLEPROC, Disable)                                 \
    X(PFNGLDRAWARRAYSPROC, DrawArrays)                           \
    X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)         \
    X(PFNGLDRAWBUFFERSPROC, DrawBuffers)                         \
    X(PFNGLDRAWELEMENTSPROC, DrawElements)                       \
    X(PFNGLDRAWELEMENTSINSTANCEDPROC, DrawElementsInstanced)     \
    X(PFNGLENABLEPROC, Enable)                                   \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray) \
    X(PFNGLFINISHPROC, Finish)                                   \
    X(PFNGLFLUSHPROC, Flush)                                     \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer) \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)       \
    X(PFNGLFRONTFACEPROC, FrontFace)                             \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                           \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                 \
    X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)               \
    X(PFNGLGENTEXTURESPROC, GenTextures)                         \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                 \
    X(PFNGLGENERATEMIPMAPPROC, GenerateMipmap)                   \
    X(PFNGLGETACTIVEATTRIBPROC, GetActiveAttrib)                 \
    X(PFNGLGETACTIVEUNIFORMPROC, GetActiveUniform)               \
    X(PFNGLGETATTRIBLOCATIONPROC, GetAttribLocation)             \
    X(PFNGLGETBUFFERSUBDATAPROC, GetBufferSubData)               \
    X(PFNGLGETERRORPROC, GetError)                               \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                         \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)             \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                       \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)               \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                         \
    X(PFNGLGETSTRINGPROC, GetString)                             \
    X(PFNGLGETSTRINGIPROC, GetStringi)                           \
    X(PFNGLGETTEXIMAGEPROC, GetTexImage)                         \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)           \
    X(PFNGLGETUNIFORMFVPROC, GetUniformfv)                       \
    X(PFNGLGETUNIFORMIVPROC, GetUniformiv)                       \
    X(PFNGLGETUNIFORMUIVPROC, GetUniformuiv)                     \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                         \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                         \
    X(PFNGLPOLYGONMODEPROC, PolygonMode)                         \
    X(PFNGLREADBUFFERPROC, ReadBuffer)                           \
    X(PFNGLREADPIXELSPROC, ReadPixels)                           \
    X(PFNGLRENDERBUFFERSTORAGEPROC, RenderbufferStorage)         \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                       \
    X(PFNGLSTENCILFUNCSEPARATEPROC, StencilFuncSeparate)         \
    X(PFNGLSTENCILMASKPROC, StencilMask)                         \
    X(PFNGLSTENCILOPSEPARATEPROC, StencilOpSeparate)             \
    X(PFNGLTEXBUFFERPROC, TexBuffer)                             \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                           \
    X(PFNGLTEXIMAGE3DPROC, TexImage3D)                           \
    X(PFNGLTEXPARAMETERIPROC, TexParameteri)                     \
    X(PFNGLUNIFORM1FVPROC, Uniform1fv)                           \
    X(PFNGLUNIFORM1IPROC, Uniform1i)                             \
    X(PFNGLUNIFORM1IVPROC, Uniform1iv)                           \
    X(PFNGLUNIFORM1UIVPROC, Uniform1uiv)                         \
    X(PFNGLUNIFORM2FVPROC, Uniform2fv)                           \
    X(PFNGLUNIFORM2IVPROC, Uniform2iv)                           \
    X(PFNGLUNIFORM2UIVPROC, Uniform2uiv)                         \
    X(PFNGLUNIFORM3FVPROC, Uniform3fv)                           \
    X(PFNGLUNIFORM3IVPROC, Uniform3iv)                           \
    X(PFNGLUNIFORM3UIVPROC, Uniform3uiv)                         \
    X(PFNGLUNIFORM4FVPROC, Uniform4fv)                           \
    X(PFNGLUNIFORM4IVPROC, Uniform4iv)                           \
    X(PFNGLUNIFORM4UIVPROC, Uniform4uiv)                         \
    X(PFNGLUNIFORMMATRIX2FVPROC, UniformMatrix2fv)               \
    X(PFNGLUNIFORMMATRIX2X3FVPROC, UniformMatrix2x3fv)           \
    X(PFNGLUNIFORMMATRIX2X4FVPROC, UniformMatrix2x4fv)           \
    X(PFNGLUNIFORMMATRIX3FVPROC, UniformMatrix3fv)               \
    X(PFNGLUNIFORMMATRIX3X2FVPROC, UniformMatrix3x2fv)           \
    X(PFNGLUNIFORMMATRIX3X4FVPROC, UniformMatrix3x4fv)           \
    X(PFNGLUNIFORMMATRIX4FVPROC, UniformMatrix4fv)               \
    X(PFNGLUNIFORMMATRIX4X2FVPROC, UniformMatrix4x2fv)           \
    X(PFNGLUNIFORMMATRIX4X3FVPROC, UniformMatrix4x3fv)           \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                           \
    X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)         \
    X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)         \
    X(PFNGLVIEWPORTPROC, Viewport)

/* In GL 4.3, some of them earlier: NULL in a context of less. */
#define HN_GL_43(X)                                                \
    X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                     \
    X(PFNGLBINDIMAGETEXTUREPROC, BindImageTexture)                 \
    X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute)                   \
    X(PFNGLGETSHADERPRECISIONFORMATPROC, GetShaderPrecisionFormat) \
    X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)                       \
    X(PFNGLPATCHPARAMETERIPROC, PatchParameteri)

#define HN_GL_MEMBER(type, name) type name;
typedef struct {
    HN_GL_33(HN_GL_MEMBER)
    HN_GL_43(HN_GL_MEMBER)
} hn_gl;
#undef HN_GL_MEMBER

/* Of the open context; all NULL without one. */
extern hn_gl gl;

typedef void (*hn_gl_function)(void);

/* Fills the table for the context that is current. Fails when a function of GL 3.3 is missing. */
int hn_gl_load(hn_gl_function (*get)(const char *name));
void hn_gl_unload(void);
/* 1 when the open context offers the extension. The only valid test: OSMesa finds functions of any name. */
int hn_gl_has(const char *extension);

/* Takes all pending GL errors; when there are any, fails with "OPERATION: GL_INVALID_VALUE". The operation is
 * written as by printf and should name its object: hn_check_gl("hn_texture_bind: unit %d", unit). */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
int hn_check_gl(const char *operation, ...);

#endif
