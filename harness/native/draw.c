/* draw.c: targets to draw to, draws of meshes, and what was drawn, read back. */
#include "internal.h"

#include <stddef.h>
#include <stdlib.h>

struct hn_target {
    uint32_t context_id;
    uint32_t framebuffer, color, depth;
    int width, height;
    int alpha; /* 0: alpha reads as 1, whatever the format that holds the colour */
};

/* Attaches a colour texture of this format and tells whether the framebuffer can be drawn to. */
static int color_works(const hn_target *target, GLint format, GLenum components) {
    gl.TexImage2D(GL_TEXTURE_2D, 0, format, target->width, target->height, 0, components, GL_FLOAT, NULL);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target->color, 0);
    return gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

static int make_framebuffer(const char *operation, hn_target *target) {
    GLint bound = 0;
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    gl.GenFramebuffers(1, &target->framebuffer);
    gl.GenTextures(1, &target->color);
    gl.GenRenderbuffers(1, &target->depth);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl.BindRenderbuffer(GL_RENDERBUFFER, target->depth);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, target->width, target->height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target->depth);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl.BindTexture(GL_TEXTURE_2D, target->color);
    /* There are no mipmaps, so a filter that wants them would leave the texture incomplete. */
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    /* GL leaves it to the driver whether three floats can be drawn to; four floats always can. */
    int works = (!target->alpha && color_works(target, GL_RGB32F, GL_RGB)) ||
                color_works(target, GL_RGBA32F, GL_RGBA);
    gl.BindTexture(GL_TEXTURE_2D, (GLuint)bound);
    if (hn_check_gl("%s: %d x %d", operation, target->width, target->height))
        return -1;
    if (!works)
        return hn_fail("%s: %d x %d: the driver draws to no float framebuffer", operation, target->width,
                       target->height);
    return 0;
}

hn_target *hn_target_create(int width, int height, int alpha) {
    const char *operation = "hn_target_create";
    if (hn_context_check(operation) || hn_image_check(operation, width, height, 4 * sizeof(float)))
        return NULL;
    hn_target *target = calloc(1, sizeof *target);
    if (!target) {
        hn_fail("%s: out of memory", operation);
        return NULL;
    }
    *target =
        (hn_target){.context_id = hn_context_id(), .width = width, .height = height, .alpha = alpha != 0};
    /* GL leaves a new framebuffer's colour and depth to chance; a picture must not depend on it. */
    const float black[4] = {0};
    if (make_framebuffer(operation, target) || hn_target_clear(target, black)) {
        hn_target_delete(target);
        return NULL;
    }
    return target;
}

void hn_target_delete(hn_target *target) {
    if (!target)
        return;
    /* With its context gone all else is gone too, and the names may be another's. */
    if (target->context_id == hn_context_id() && !hn_context_check("hn_target_delete")) {
        gl.DeleteFramebuffers(1, &target->framebuffer);
        gl.DeleteTextures(1, &target->color);
        gl.DeleteRenderbuffers(1, &target->depth);
        hn_check_gl("hn_target_delete");
    }
    free(target);
}

/* Makes the target the one that is drawn to and read from. */
static int use_target(const char *operation, const hn_target *target) {
    if (hn_context_check(operation))
        return -1;
    if (!target)
        return hn_fail("%s: no target", operation);
    if (target->context_id != hn_context_id())
        return hn_fail("%s: the target's context was closed", operation);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    return 0;
}

/* Whatever else could keep a pixel from being written. */
static void write_everything(void) {
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_STENCIL_TEST);
    gl.Disable(GL_RASTERIZER_DISCARD);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.DepthMask(GL_TRUE);
}

int hn_target_clear(hn_target *target, const float rgba[4]) {
    const char *operation = "hn_target_clear";
    if (use_target(operation, target))
        return -1;
    if (!rgba)
        return hn_fail("%s: no colour", operation);
    write_everything();
    const float farthest = 1;
    gl.ClearBufferfv(GL_COLOR, 0, rgba);
    gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
    return hn_check_gl("%s: %d x %d", operation, target->width, target->height);
}

/* Where a field lies in hn_vertex, and of how many floats it is. */
static const struct {
    size_t offset;
    GLint components;
} layout[] = {
    [HN_POSITION] = {offsetof(hn_vertex, position), 3},   [HN_NORMAL] = {offsetof(hn_vertex, normal), 3},
    [HN_TEXCOORD] = {offsetof(hn_vertex, texcoord), 2},   [HN_TANGENT] = {offsetof(hn_vertex, tangent), 3},
    [HN_BITANGENT] = {offsetof(hn_vertex, bitangent), 3}, [HN_COLOR] = {offsetof(hn_vertex, color), 4},
};

static void draw_part(const hn_part *part, const hn_field *fields, int n_fields) {
    for (int i = 0; i < n_fields; ++i) {
        size_t offset = part->first_vertex * sizeof(hn_vertex) + layout[fields[i]].offset;
        gl.VertexAttribPointer((GLuint)i, layout[fields[i]].components, GL_FLOAT, GL_FALSE, sizeof(hn_vertex),
                               (const void *)offset);
    }
    size_t first_index = part->first_index * sizeof(uint32_t);
    gl.DrawElements(GL_TRIANGLES, (GLsizei)part->n_indices, GL_UNSIGNED_INT, (const void *)first_index);
}

static int check_fields(const char *operation, const hn_field *fields, int n_fields) {
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_VERTEX_ATTRIBS, &limit);
    if (n_fields < 0 || n_fields > limit || (n_fields > 0 && !fields))
        return hn_fail("%s: %d fields given: the driver takes 0 ... %d", operation, fields ? n_fields : 0,
                       limit);
    for (int i = 0; i < n_fields; ++i)
        if ((unsigned)fields[i] > HN_COLOR)
            return hn_fail("%s: field %d is %d: there are 0 ... %d", operation, i, (int)fields[i], HN_COLOR);
    return 0;
}

static void set_state(const hn_state *state) {
    static const hn_state at_start_of_pass = {GL_BACK, GL_CCW, 0};
    if (!state)
        state = &at_start_of_pass;
    if (state->cull == GL_NONE) {
        gl.Disable(GL_CULL_FACE);
    } else {
        gl.Enable(GL_CULL_FACE);
        gl.CullFace(state->cull);
    }
    gl.FrontFace(state->front);
    if (state->depth_clamp)
        gl.Enable(GL_DEPTH_CLAMP);
    else
        gl.Disable(GL_DEPTH_CLAMP);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    gl.Disable(GL_BLEND);
}

int hn_draw(hn_target *target, uint32_t program, const hn_mesh *mesh, const hn_field *fields, int n_fields,
            const hn_state *state) {
    const char *operation = "hn_draw";
    if (use_target(operation, target) || check_fields(operation, fields, n_fields))
        return -1;
    if (!mesh || program == 0)
        return hn_fail("%s: no %s", operation, mesh ? "program" : "mesh");
    if (mesh->context_id != hn_context_id())
        return hn_fail("%s: the mesh's context was closed", operation);
    gl.UseProgram(program);
    /* Before drawing: a program refused leaves the one before it in use. */
    if (hn_check_gl("%s: program %u", operation, program))
        return -1;

    write_everything();
    gl.Viewport(0, 0, target->width, target->height);
    set_state(state);

    /* One of its own, so that no draw sees the attributes of another. */
    GLuint vertex_array = 0;
    gl.GenVertexArrays(1, &vertex_array);
    gl.BindVertexArray(vertex_array);
    gl.BindBuffer(GL_ARRAY_BUFFER, mesh->vertex_buffer);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->index_buffer);
    for (int i = 0; i < n_fields; ++i)
        gl.EnableVertexAttribArray((GLuint)i);
    for (size_t i = 0; i < mesh->n_parts; ++i)
        if (mesh->parts[i].n_indices > 0)
            draw_part(&mesh->parts[i], fields, n_fields);
    gl.BindVertexArray(0);
    gl.DeleteVertexArrays(1, &vertex_array);
    return hn_check_gl("%s: program %u, %zu indices", operation, program, mesh->n_indices);
}

/* Through glReadPixels in the wanted type, so that GL clamps and rounds, as it does for SHADERed. */
static int read_pixels(const char *operation, const hn_target *target, GLenum type, void *rgba) {
    if (use_target(operation, target))
        return -1;
    if (!rgba)
        return hn_fail("%s: nowhere to put the pixels", operation);
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    /* A row of RGBA is a multiple of 4 bytes at any width. */
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, target->width, target->height, GL_RGBA, type, rgba);
    return hn_check_gl("%s: %d x %d", operation, target->width, target->height);
}

int hn_target_read_bytes(hn_target *target, uint8_t *rgba) {
    if (read_pixels("hn_target_read_bytes", target, GL_UNSIGNED_BYTE, rgba))
        return -1;
    size_t n_values = 4 * (size_t)target->width * (size_t)target->height;
    for (size_t i = 3; !target->alpha && i < n_values; i += 4)
        rgba[i] = 255;
    return 0;
}

int hn_target_read_floats(hn_target *target, float *rgba) {
    if (read_pixels("hn_target_read_floats", target, GL_FLOAT, rgba))
        return -1;
    size_t n_values = 4 * (size_t)target->width * (size_t)target->height;
    for (size_t i = 3; !target->alpha && i < n_values; i += 4)
        rgba[i] = 1;
    return 0;
}
