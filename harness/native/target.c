/* target.c: what is drawn to: colour textures with depth and stencil, single and joined; cleared, and read back. */
#include "internal.h"

#include <stdlib.h>

enum { TARGETS_MAX = 16 };

struct hn_target {
    uint32_t context_id;
    uint32_t framebuffer;
    uint32_t color, depth; /* 0 of joined targets: theirs are the others' */
    int n_colors;
    int width, height;
    int opaque; /* 1: alpha reads as 1, whatever the format that holds the colour */
};

static void set_draw_buffers(int count) {
    GLenum buffers[TARGETS_MAX];
    for (int i = 0; i < count; ++i)
        buffers[i] = (GLenum)(GL_COLOR_ATTACHMENT0 + i);
    gl.DrawBuffers(count, buffers);
}

static void attach(int index, uint32_t color) {
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, (GLenum)(GL_COLOR_ATTACHMENT0 + index), GL_TEXTURE_2D, color, 0);
}

static int complete(void) {
    return gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

/* Attaches a colour texture of this format and tells whether the framebuffer can be drawn to. */
static int color_works(const hn_target *target, uint32_t format) {
    gl.TexImage2D(GL_TEXTURE_2D, 0, (GLint)format, target->width, target->height, 0, GL_RGBA,
                  GL_UNSIGNED_BYTE, NULL);
    attach(0, target->color);
    return complete();
}

static int make_framebuffer(const char *operation, hn_target *target, uint32_t format) {
    GLint bound = 0;
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    gl.GenFramebuffers(1, &target->framebuffer);
    gl.GenTextures(1, &target->color);
    gl.GenRenderbuffers(1, &target->depth);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl.BindRenderbuffer(GL_RENDERBUFFER, target->depth);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, target->width, target->height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, target->depth);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl.BindTexture(GL_TEXTURE_2D, target->color);
    /* There are no mipmaps, so a filter that wants them would leave the texture incomplete. */
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    /* GL leaves it to the driver whether three floats can be drawn to; four floats always can. */
    int works = color_works(target, format);
    if (!works && format == GL_RGB32F) {
        target->opaque = 1;
        works = color_works(target, GL_RGBA32F);
    }
    gl.BindTexture(GL_TEXTURE_2D, (GLuint)bound);
    if (hn_check_gl("%s: %d x %d, format 0x%04X", operation, target->width, target->height, format))
        return -1;
    if (!works)
        return hn_fail("%s: %d x %d: the driver draws to no texture of format 0x%04X", operation,
                       target->width, target->height, format);
    return 0;
}

/* GL leaves a new framebuffer's content to chance; a picture must not depend on it. */
static int set_to_zero(const char *operation) {
    const float black[4] = {0};
    hn_write_everything();
    gl.ClearBufferfv(GL_COLOR, 0, black);
    gl.ClearBufferfi(GL_DEPTH_STENCIL, 0, 0, 0);
    return hn_check_gl("%s: first clear", operation);
}

static hn_target *new_target(const char *operation, int width, int height, int n_colors) {
    hn_target *target = calloc(1, sizeof *target);
    if (!target) {
        hn_fail("%s: out of memory", operation);
        return NULL;
    }
    *target =
        (hn_target){.context_id = hn_context_id(), .n_colors = n_colors, .width = width, .height = height};
    return target;
}

hn_target *hn_target_create(int width, int height, uint32_t format) {
    const char *operation = "hn_target_create";
    if (hn_context_check(operation) || hn_image_check(operation, width, height, 4 * sizeof(float)))
        return NULL;
    hn_target *target = new_target(operation, width, height, 1);
    if (target && (make_framebuffer(operation, target, format) || set_to_zero(operation))) {
        hn_target_delete(target);
        target = NULL;
    }
    return target;
}

hn_target *hn_target_join(hn_target *const *targets, int n_targets, int width, int height) {
    const char *operation = "hn_target_join";
    if (hn_context_check(operation))
        return NULL;
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &limit);
    if (!targets || n_targets < 1 || n_targets > TARGETS_MAX || n_targets > limit) {
        hn_fail("%s: %d targets: the driver takes 1 to %d", operation, targets ? n_targets : 0,
                limit < TARGETS_MAX ? limit : TARGETS_MAX);
        return NULL;
    }
    for (int i = 0; i < n_targets; ++i)
        if (!targets[i] || targets[i]->context_id != hn_context_id() || targets[i]->color == 0) {
            hn_fail("%s: target %d is none that can be joined", operation, i);
            return NULL;
        }
    hn_target *joined = new_target(operation, width, height, n_targets);
    if (!joined)
        return NULL;
    joined->opaque = targets[0]->opaque;
    gl.GenFramebuffers(1, &joined->framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, joined->framebuffer);
    for (int i = 0; i < n_targets; ++i)
        attach(i, targets[i]->color);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                               targets[n_targets - 1]->depth);
    set_draw_buffers(n_targets);
    if (!complete())
        hn_fail("%s: the driver does not draw to these %d formats and sizes at once", operation, n_targets);
    else if (!hn_check_gl("%s: %d targets", operation, n_targets))
        return joined;
    hn_target_delete(joined);
    return NULL;
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

uint32_t hn_target_texture(const hn_target *target) {
    return target ? target->color : 0;
}

int hn_target_use(const char *operation, const hn_target *target) {
    if (hn_context_check(operation))
        return -1;
    if (!target)
        return hn_fail("%s: no target", operation);
    if (target->context_id != hn_context_id())
        return hn_fail("%s: the target's context was closed", operation);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    return 0;
}

void hn_target_size(const hn_target *target, int *width, int *height) {
    *width = target->width;
    *height = target->height;
}

void hn_write_everything(void) {
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_STENCIL_TEST);
    gl.Disable(GL_RASTERIZER_DISCARD);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.DepthMask(GL_TRUE);
    gl.StencilMask(0xFFFFFFFF);
}

int hn_target_clear_color(hn_target *target, int index, const float rgba[4]) {
    const char *operation = "hn_target_clear_color";
    if (hn_target_use(operation, target))
        return -1;
    if (!rgba)
        return hn_fail("%s: no colour", operation);
    if (index < 0 || index >= target->n_colors)
        return hn_fail("%s: no colour %d of %d", operation, index, target->n_colors);
    hn_write_everything();
    gl.ClearBufferfv(GL_COLOR, index, rgba);
    return hn_check_gl("%s: %d x %d", operation, target->width, target->height);
}

int hn_target_clear_depth(hn_target *target, int write_depth) {
    const char *operation = "hn_target_clear_depth";
    if (hn_target_use(operation, target))
        return -1;
    hn_write_everything();
    gl.DepthMask(write_depth ? GL_TRUE : GL_FALSE);
    gl.ClearBufferfi(GL_DEPTH_STENCIL, 0, 1, 0);
    return hn_check_gl("%s: %d x %d", operation, target->width, target->height);
}

/* Through glReadPixels in the wanted type, so that GL clamps and rounds, as it does for SHADERed. */
static int read_pixels(const char *operation, const hn_target *target, GLenum type, void *rgba) {
    if (hn_target_use(operation, target))
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
    for (size_t i = 3; target->opaque && i < n_values; i += 4)
        rgba[i] = 255;
    return 0;
}

int hn_target_read_floats(hn_target *target, float *rgba) {
    if (read_pixels("hn_target_read_floats", target, GL_FLOAT, rgba))
        return -1;
    size_t n_values = 4 * (size_t)target->width * (size_t)target->height;
    for (size_t i = 3; target->opaque && i < n_values; i += 4)
        rgba[i] = 1;
    return 0;
}
