/* evaluate.c: runs a fragment shader once for each element of arrays, and reads back what it makes of them.
 *
 *   - The batch is drawn in tiles into targets that stay, small enough that their pages are touched once and their
 *     readback comes from the cache: a new target of a large batch's size costs as much as the drawing.
 *   - There are two targets: while one is read back, on this thread, the driver's threads draw into the other.
 */
#include "internal.h"

#include <stdio.h>
#include <string.h>

enum {
    TILE_WIDTH = 2048,
    TILE_HEIGHT = 1024,
    TILE_WIDTH_MIN = 16,
    TARGETS = 2,
};

/* A target that stays: attachments 0 ... n_outputs-1 of one size. It dies with its context. */
typedef struct {
    uint32_t context_id;
    GLuint framebuffer;
    GLuint textures[HN_OUTPUTS_MAX];
    int n_outputs, width, height;
} tile_target;
static tile_target targets[TARGETS];

static int target_reserve(tile_target *target, int width, int height, int n_outputs) {
    if (target->context_id == hn_context_id()) {
        if (target->width >= width && target->height >= height && target->n_outputs >= n_outputs)
            return 0;
        gl.DeleteTextures(HN_OUTPUTS_MAX, target->textures);
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
    GLenum attachments[HN_OUTPUTS_MAX];
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

int hn_evaluate(uint32_t program, const hn_input *inputs, int n_inputs, const hn_output *outputs,
                int n_outputs, size_t count) {
    if (hn_context_check("hn_evaluate"))
        return -1;
    if (hn_arrays_check(inputs, n_inputs, outputs, n_outputs, 4))
        return -1;
    GLint attachments = 0;
    gl.GetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &attachments);
    if (n_outputs > attachments)
        return hn_fail("hn_evaluate: %d outputs, but this driver gives at most %d", n_outputs, attachments);
    if (count > hn_evaluate_limit())
        return hn_fail("hn_evaluate: %zu elements, but at most %zu at a time", count, hn_evaluate_limit());
    if (count == 0)
        return 0;

    int width = tile_width(count);
    size_t rows = (count + (size_t)width - 1) / (size_t)width;
    int height = rows < TILE_HEIGHT ? (int)rows : TILE_HEIGHT;
    for (int k = 0; k < TARGETS && (k == 0 || rows > TILE_HEIGHT); ++k)
        if (target_reserve(&targets[k], width, height, n_outputs))
            return -1;
    gl.UseProgram(program);

    hn_bound_inputs bound;
    int failed = hn_inputs_bind(&bound, program, inputs, n_inputs);
    if (!failed)
        draw_tiles(program, outputs, n_outputs, count, width);
    gl.Finish(); /* the caller may free pinned memory from here on */
    hn_inputs_release(&bound);
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
