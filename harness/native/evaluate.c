/* evaluate.c: runs a fragment shader once for each element of arrays, and reads back what it makes of them.
 *
 * Fetching costs more than the arithmetic of a whole reflection model, so nothing is copied that need not be:
 *   - Inputs are buffer textures over the caller's own memory (GL_AMD_pinned_memory), copied only where the driver
 *     cannot do that or the memory is not aligned for it.
 *   - The batch is drawn in tiles into targets that stay, small enough that their pages are touched once and their
 *     readback comes from the cache: a new target of a large batch's size costs as much as the drawing.
 *   - There are two targets: while one is read back, on this thread, the driver's threads draw into the other.
 */
#include "internal.h"

#include <GL/glext.h>

#include <stdio.h>
#include <string.h>

enum {
    TILE_WIDTH = 2048,
    TILE_HEIGHT = 1024,
    TILE_WIDTH_MIN = 16,
    TARGETS = 2,
    OUTPUTS_MAX = 8,
    INPUTS_MAX = 64,
    PIN_ALIGNMENT = 16, /* of the widest texel, RGBA32F: the driver may load it by one instruction */
};

/* A target that stays: attachments 0 ... n_outputs-1 of one size. It dies with its context. */
typedef struct {
    uint32_t context_id;
    GLuint framebuffer;
    GLuint textures[OUTPUTS_MAX];
    int n_outputs, width, height;
} tile_target;
static tile_target targets[TARGETS];

static int target_reserve(tile_target *target, int width, int height, int n_outputs) {
    if (target->context_id == hn_context_id()) {
        if (target->width >= width && target->height >= height && target->n_outputs >= n_outputs)
            return 0;
        gl.DeleteTextures(OUTPUTS_MAX, target->textures);
        gl.DeleteFramebuffers(1, &target->framebuffer);
        width = width > target->width ? width : target->width;
        height = height > target->height ? height : target->height;
        n_outputs = n_outputs > target->n_outputs ? n_outputs : target->n_outputs;
    }
    memset(target, 0, sizeof *target);
    GLint bound = 0;
    gl.ActiveTexture(GL_TEXTURE0);
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    gl.GenFramebuffers(1, &target->framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl.GenTextures(n_outputs, target->textures);
    for (int k = 0; k < n_outputs; ++k) {
        gl.BindTexture(GL_TEXTURE_2D, target->textures[k]);
        gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + (GLenum)k, GL_TEXTURE_2D,
                                target->textures[k], 0);
    }
    gl.BindTexture(GL_TEXTURE_2D, (GLuint)bound);
    target->context_id = hn_context_id();
    GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (hn_check_gl("hn_evaluate: target of %d x %d, %d outputs", width, height, n_outputs))
        return -1;
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return hn_fail("hn_evaluate: the driver does not draw to %d RGBA32F outputs (status 0x%x)", n_outputs,
                       status);
    target->width = width;
    target->height = height;
    target->n_outputs = n_outputs;
    return 0;
}

/* The format of a buffer texture with this texel; 0 for none. */
static GLenum texel_format(uint32_t base, uint32_t components) {
    static const GLenum formats[3][4] = {{GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F},
                                         {GL_R32I, GL_RG32I, GL_RGB32I, GL_RGBA32I},
                                         {GL_R32UI, GL_RG32UI, GL_RGB32UI, GL_RGBA32UI}};
    if (components < 1 || components > 4)
        return 0;
    switch (base) {
    case GL_FLOAT:
        return formats[0][components - 1];
    case GL_INT:
        return formats[1][components - 1];
    case GL_UNSIGNED_INT:
        return formats[2][components - 1];
    default:
        return 0;
    }
}

static int input_check(const hn_input *input) {
    if (!texel_format(input->base, input->components))
        return hn_fail("hn_evaluate: input %s: %u components of type 0x%x are no texel", input->name,
                       input->components, input->base);
    if (input->count == 0 || input->count > hn_evaluate_limit())
        return hn_fail("hn_evaluate: input %s: %zu texels, but 1 ... %zu can be", input->name, input->count,
                       hn_evaluate_limit());
    return 0;
}

/* Makes the buffer texture of an input on a unit. An input that the program does not read is left out. */
static void input_bind(uint32_t program, const hn_input *input, int unit, int pin, GLuint buffer,
                       GLuint texture) {
    GLint location = gl.GetUniformLocation(program, input->name);
    if (location < 0)
        return;
    GLenum binding = GL_TEXTURE_BUFFER;
    if (pin && (uintptr_t)input->data % PIN_ALIGNMENT == 0)
        binding = GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD;
    gl.BindBuffer(binding, buffer);
    gl.BufferData(binding, (GLsizeiptr)(input->count * input->components * 4), input->data, GL_STREAM_DRAW);
    gl.BindBuffer(binding, 0);
    gl.ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    gl.BindTexture(GL_TEXTURE_BUFFER, texture);
    gl.TexBuffer(GL_TEXTURE_BUFFER, texel_format(input->base, input->components), buffer);
    gl.Uniform1i(location, unit);
}

/* Reads the first `count` elements of the tile, a whole number of rows and a rest, to element `first` of the
 * outputs. */
static void tile_read(const hn_output *outputs, int n_outputs, int width, size_t first, size_t count) {
    static const GLenum formats[4] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    int rows = (int)(count / (size_t)width);
    int rest = (int)(count % (size_t)width);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    for (int k = 0; k < n_outputs; ++k) {
        GLenum format = formats[outputs[k].components - 1];
        float *to = outputs[k].data + first * outputs[k].components;
        gl.ReadBuffer(GL_COLOR_ATTACHMENT0 + (GLenum)k);
        if (rows)
            gl.ReadPixels(0, 0, width, rows, format, GL_FLOAT, to);
        if (rest)
            gl.ReadPixels(0, rows, rest, 1, format, GL_FLOAT,
                          to + (size_t)rows * (size_t)width * outputs[k].components);
    }
}

/* The narrowest power of two that makes the tile of a small batch about square, so that it needs few rows of
 * few blocks. */
static int tile_width(size_t count) {
    int width = TILE_WIDTH_MIN;
    while (width < TILE_WIDTH && (size_t)width * (size_t)width < count)
        width *= 2;
    return width;
}

static void draw_tiles(uint32_t program, const hn_output *outputs, int n_outputs, size_t count, int width) {
    GLenum attachments[OUTPUTS_MAX];
    for (int k = 0; k < n_outputs; ++k)
        attachments[k] = GL_COLOR_ATTACHMENT0 + (GLenum)k;
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Disable(GL_BLEND);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_DEPTH_TEST);
    gl.BindVertexArray(hn_context_vertex_array());
    gl.Uniform1i(gl.GetUniformLocation(program, "hn_width"), width);
    GLint first_location = gl.GetUniformLocation(program, "hn_first");

    size_t tile = (size_t)width * TILE_HEIGHT;
    size_t n_tiles = (count + tile - 1) / tile;
    for (size_t k = 0; k <= n_tiles; ++k) { /* draws tile k, then reads tile k-1 */
        if (k < n_tiles) {
            size_t first = k * tile;
            size_t n = count - first < tile ? count - first : tile;
            gl.BindFramebuffer(GL_FRAMEBUFFER, targets[k % TARGETS].framebuffer);
            gl.DrawBuffers(n_outputs, attachments);
            gl.Uniform1i(first_location, (GLint)first);
            gl.Viewport(0, 0, width, (GLsizei)((n + (size_t)width - 1) / (size_t)width));
            gl.DrawArrays(GL_TRIANGLES, 0, 3);
            gl.Flush();
        }
        if (k > 0) {
            size_t first = (k - 1) * tile;
            gl.BindFramebuffer(GL_FRAMEBUFFER, targets[(k - 1) % TARGETS].framebuffer);
            tile_read(outputs, n_outputs, width, first, count - first < tile ? count - first : tile);
        }
    }
}

/* Whether inputs can be read where they lie; asked once a context, for the driver lists hundreds of extensions. */
static int can_pin(void) {
    static uint32_t context_id;
    static int answer;
    if (context_id != hn_context_id()) {
        context_id = hn_context_id();
        answer = hn_gl_has("GL_AMD_pinned_memory");
    }
    return answer;
}

int hn_evaluate(uint32_t program, const hn_input *inputs, int n_inputs, const hn_output *outputs,
                int n_outputs, size_t count) {
    if (hn_context_check("hn_evaluate"))
        return -1;
    GLint units = 0, attachments = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    gl.GetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &attachments);
    units = units < INPUTS_MAX ? units : INPUTS_MAX;
    attachments = attachments < OUTPUTS_MAX ? attachments : OUTPUTS_MAX;
    if (n_inputs < 0 || n_inputs > units)
        return hn_fail("hn_evaluate: %d inputs, but this driver takes at most %d", n_inputs, units);
    if (n_outputs < 1 || n_outputs > attachments)
        return hn_fail("hn_evaluate: %d outputs, but this driver gives 1 ... %d", n_outputs, attachments);
    if (count > hn_evaluate_limit())
        return hn_fail("hn_evaluate: %zu elements, but at most %zu at a time", count, hn_evaluate_limit());
    for (int k = 0; k < n_inputs; ++k)
        if (input_check(&inputs[k]))
            return -1;
    for (int k = 0; k < n_outputs; ++k)
        if (outputs[k].components < 1 || outputs[k].components > 4)
            return hn_fail("hn_evaluate: output %d: %u components, but 1 ... 4 can be", k,
                           outputs[k].components);
    if (count == 0)
        return 0;

    int width = tile_width(count);
    size_t rows = (count + (size_t)width - 1) / (size_t)width;
    int height = rows < TILE_HEIGHT ? (int)rows : TILE_HEIGHT;
    for (int k = 0; k < TARGETS && (k == 0 || rows > TILE_HEIGHT); ++k)
        if (target_reserve(&targets[k], width, height, n_outputs))
            return -1;
    gl.UseProgram(program);

    GLuint buffers[INPUTS_MAX], textures[INPUTS_MAX];
    int pin = can_pin();
    gl.GenBuffers(n_inputs, buffers);
    gl.GenTextures(n_inputs, textures);
    for (int k = 0; k < n_inputs; ++k)
        input_bind(program, &inputs[k], k, pin, buffers[k], textures[k]);
    int failed = hn_check_gl("hn_evaluate: inputs of program %u", program);
    if (!failed)
        draw_tiles(program, outputs, n_outputs, count, width);
    gl.Finish(); /* the caller may free pinned memory from here on */
    gl.DeleteTextures(n_inputs, textures);
    gl.DeleteBuffers(n_inputs, buffers);
    gl.UseProgram(0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.BindVertexArray(0);
    return failed ? -1 : hn_check_gl("hn_evaluate: program %u over %zu elements", program, count);
}

const char *hn_evaluate_vertex(void) {
    return "#version 330\n"
           "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); "
           "}\n";
}

size_t hn_evaluate_limit(void) {
    GLint texels = 0;
    if (hn_context_check("hn_evaluate_limit") == 0)
        gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    return (size_t)texels;
}
