/* texture.c: textures and images, and which sizes of them we take. */
#include "internal.h"

#include <stdlib.h>

int hn_image_check(const char *operation, int width, int height, size_t bytes_per_pixel) {
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (width < 1 || height < 1)
        return hn_fail("%s: %d x %d pixels: both must be at least 1", operation, width, height);
    if (width > limit || height > limit)
        return hn_fail("%s: %d x %d pixels: the driver's limit is %d each", operation, width, height, limit);
    /* No overflow: the driver's limit is far below the square root of what size_t holds. */
    size_t bytes = (size_t)width * (size_t)height * bytes_per_pixel;
    if (bytes > HN_IMAGE_BYTES_MAX)
        return hn_fail("%s: %d x %d pixels take %zu MiB: at most %zu MiB work", operation, width, height,
                       bytes >> 20, HN_IMAGE_BYTES_MAX >> 20);
    return 0;
}

/* How the texels of a format are given: 0 when it is none of ours. */
static size_t texel_bytes(uint32_t format, GLenum *layout, GLenum *type) {
    switch (format) {
    case GL_RGBA8:
        *layout = GL_RGBA;
        *type = GL_UNSIGNED_BYTE;
        return 4;
    case GL_RGBA32F:
        *layout = GL_RGBA;
        *type = GL_FLOAT;
        return 16;
    case GL_RGBA32I:
        *layout = GL_RGBA_INTEGER;
        *type = GL_INT;
        return 16;
    case GL_RGBA32UI:
        *layout = GL_RGBA_INTEGER;
        *type = GL_UNSIGNED_INT;
        return 16;
    default:
        return 0;
    }
}

/* The same for one with a depth, where that is above 0. */
static int check_depth(const char *operation, int width, int height, int depth, size_t bytes_per_pixel) {
    if (depth == 0)
        return hn_image_check(operation, width, height, bytes_per_pixel);
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
    if (depth < 1 || width > limit || height > limit || depth > limit)
        return hn_fail("%s: %d x %d x %d pixels: the driver's limit is %d each", operation, width, height,
                       depth, limit);
    return hn_image_check(operation, width, height, bytes_per_pixel * (size_t)depth);
}

/* A texture in the making; what was bound to its target in the active unit is put back at its end. */
typedef struct {
    GLenum target;
    GLuint texture;
    GLint bound;
} making;

static GLint bound_to(GLenum target) {
    GLint bound = 0;
    gl.GetIntegerv(target == GL_TEXTURE_2D   ? GL_TEXTURE_BINDING_2D
                   : target == GL_TEXTURE_3D ? GL_TEXTURE_BINDING_3D
                                             : GL_TEXTURE_BINDING_CUBE_MAP,
                   &bound);
    return bound;
}

static making begin(GLenum target, const hn_sampling *sampling) {
    making made = {.target = target, .bound = bound_to(target)};
    gl.GenTextures(1, &made.texture);
    gl.BindTexture(target, made.texture);
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, (GLint)sampling->min_filter);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, (GLint)sampling->mag_filter);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_S, (GLint)sampling->wrap_s);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_T, (GLint)sampling->wrap_t);
    if (target != GL_TEXTURE_2D)
        gl.TexParameteri(target, GL_TEXTURE_WRAP_R, (GLint)sampling->wrap_r);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    return made;
}

static uint32_t end(const char *operation, const making *made, int width, int height,
                    const hn_sampling *sampling) {
    gl.BindTexture(made->target, (GLuint)made->bound);
    if (hn_check_gl("%s: %d x %d, filters 0x%04X and 0x%04X, wraps 0x%04X and 0x%04X", operation, width,
                    height, sampling->min_filter, sampling->mag_filter, sampling->wrap_s, sampling->wrap_t)) {
        gl.DeleteTextures(1, &made->texture);
        return 0;
    }
    return made->texture;
}

static void set_image(GLenum target, int width, int height, int depth, GLint format, const void *rgba) {
    if (target == GL_TEXTURE_3D)
        gl.TexImage3D(target, 0, format, width, height, depth, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    else
        gl.TexImage2D(target, 0, format, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

uint32_t hn_texture_create(int width, int height, int depth, const uint8_t *rgba,
                           const hn_sampling *sampling) {
    const char *operation = "hn_texture_create";
    if (hn_context_check(operation) || check_depth(operation, width, height, depth, 4))
        return 0;
    if (!rgba || !sampling) {
        hn_fail("%s: no %s", operation, rgba ? "sampling" : "pixels");
        return 0;
    }
    making made = begin(depth ? GL_TEXTURE_3D : GL_TEXTURE_2D, sampling);
    set_image(made.target, width, height, depth, GL_RGBA8, rgba);
    gl.GenerateMipmap(made.target);
    return end(operation, &made, width, height, sampling);
}

uint32_t hn_texture_create_cube(int width, int height, const uint8_t *rgba, const hn_sampling *sampling) {
    const char *operation = "hn_texture_create_cube";
    if (hn_context_check(operation) || hn_image_check(operation, width, height, 6 * 4))
        return 0;
    if (!rgba || !sampling) {
        hn_fail("%s: no %s", operation, rgba ? "sampling" : "pixels");
        return 0;
    }
    making made = begin(GL_TEXTURE_CUBE_MAP, sampling);
    for (GLenum face = 0; face < 6; ++face)
        set_image(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, width, height, 0, GL_RGBA8,
                  rgba + face * 4 * (size_t)width * (size_t)height);
    return end(operation, &made, width, height, sampling);
}

uint32_t hn_texture_create_empty(int width, int height, int depth, uint32_t format,
                                 const hn_sampling *sampling) {
    const char *operation = "hn_texture_create_empty";
    enum { BYTES_PER_PIXEL_MAX = 16 };
    if (hn_context_check(operation) || check_depth(operation, width, height, depth, BYTES_PER_PIXEL_MAX))
        return 0;
    size_t n_pixels = (size_t)width * (size_t)height * (size_t)(depth ? depth : 1);
    uint8_t *zeros = sampling ? calloc(n_pixels, 4) : NULL;
    if (!zeros) {
        hn_fail("%s: no %s", operation, sampling ? "memory" : "sampling");
        return 0;
    }
    making made = begin(depth ? GL_TEXTURE_3D : GL_TEXTURE_2D, sampling);
    set_image(made.target, width, height, depth, (GLint)format, zeros);
    free(zeros);
    return end(operation, &made, width, height, sampling);
}

uint32_t hn_texture_create_as(uint32_t format, int width, int height, const void *texels,
                              const hn_sampling *sampling) {
    const char *operation = "hn_texture_create_as";
    GLenum layout = 0, type = 0;
    size_t bytes = texel_bytes(format, &layout, &type);
    if (hn_context_check(operation))
        return 0;
    if (bytes == 0) {
        hn_fail("%s: no texture of format 0x%04X", operation, format);
        return 0;
    }
    if (hn_image_check(operation, width, height, bytes))
        return 0;
    if (!texels || !sampling) {
        hn_fail("%s: no %s", operation, texels ? "sampling" : "pixels");
        return 0;
    }
    making made = begin(GL_TEXTURE_2D, sampling);
    gl.TexImage2D(GL_TEXTURE_2D, 0, (GLint)format, width, height, 0, layout, type, texels);
    if (layout == GL_RGBA) /* integers have none */
        gl.GenerateMipmap(GL_TEXTURE_2D);
    return end(operation, &made, width, height, sampling);
}

void hn_texture_delete(uint32_t texture) {
    if (texture == 0 || hn_context_check("hn_texture_delete"))
        return;
    gl.DeleteTextures(1, &texture);
    hn_check_gl("hn_texture_delete: texture %u", texture);
}

int hn_texture_bind(int unit, uint32_t target, uint32_t texture) {
    const char *operation = "hn_texture_bind";
    if (hn_context_check(operation))
        return -1;
    GLint units = 0;
    gl.GetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &units);
    if (unit < 0 || unit >= units)
        return hn_fail("%s: unit %d: the driver has 0 ... %d", operation, unit, units - 1);
    gl.ActiveTexture((GLenum)(GL_TEXTURE0 + unit));
    gl.BindTexture(target, texture);
    return hn_check_gl("%s: unit %d, texture %u", operation, unit, texture);
}

int hn_image_bind(int unit, uint32_t texture, uint32_t format, int layered) {
    const char *operation = "hn_image_bind";
    if (hn_context_check(operation))
        return -1;
    if (!hn_compute_available())
        return hn_fail("%s: this context has no images", operation);
    gl.BindImageTexture((GLuint)unit, texture, 0, layered ? GL_TRUE : GL_FALSE, 0, GL_READ_WRITE, format);
    return hn_check_gl("%s: unit %d, texture %u, format 0x%04X", operation, unit, texture, format);
}

int hn_texture_read(uint32_t target, uint32_t texture, float *rgba) {
    const char *operation = "hn_texture_read";
    if (hn_context_check(operation))
        return -1;
    if (!rgba)
        return hn_fail("%s: nowhere to put the pixels", operation);
    gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    GLint bound = bound_to(target);
    gl.BindTexture(target, texture);
    gl.GetTexImage(target, 0, GL_RGBA, GL_FLOAT, rgba);
    gl.BindTexture(target, (GLuint)bound);
    return hn_check_gl("%s: texture %u", operation, texture);
}
