/* texture.c: textures, and which sizes of image we take. */
#include "internal.h"

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

uint32_t hn_texture_create_as(uint32_t format, int width, int height, const void *texels, uint32_t min_filter,
                              uint32_t mag_filter, uint32_t wrap_s, uint32_t wrap_t) {
    const char *operation = "hn_texture_create";
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
    if (!texels) {
        hn_fail("%s: no pixels", operation);
        return 0;
    }
    GLint bound = 0;
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, (GLint)min_filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, (GLint)mag_filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, (GLint)wrap_s);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, (GLint)wrap_t);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexImage2D(GL_TEXTURE_2D, 0, (GLint)format, width, height, 0, layout, type, texels);
    if (layout == GL_RGBA) /* integers have none */
        gl.GenerateMipmap(GL_TEXTURE_2D);
    gl.BindTexture(GL_TEXTURE_2D, (GLuint)bound);
    if (hn_check_gl("%s: %d x %d, filters 0x%04X and 0x%04X, wraps 0x%04X and 0x%04X", operation, width,
                    height, min_filter, mag_filter, wrap_s, wrap_t)) {
        gl.DeleteTextures(1, &texture);
        return 0;
    }
    return texture;
}

uint32_t hn_texture_create(int width, int height, const uint8_t *rgba, uint32_t min_filter,
                           uint32_t mag_filter, uint32_t wrap_s, uint32_t wrap_t) {
    return hn_texture_create_as(GL_RGBA8, width, height, rgba, min_filter, mag_filter, wrap_s, wrap_t);
}

void hn_texture_delete(uint32_t texture) {
    if (texture == 0 || hn_context_check("hn_texture_delete"))
        return;
    gl.DeleteTextures(1, &texture);
    hn_check_gl("hn_texture_delete: texture %u", texture);
}

int hn_texture_bind(int unit, uint32_t texture) {
    const char *operation = "hn_texture_bind";
    if (hn_context_check(operation))
        return -1;
    GLint units = 0;
    gl.GetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &units);
    if (unit < 0 || unit >= units)
        return hn_fail("%s: unit %d: the driver has 0 ... %d", operation, unit, units - 1);
    gl.ActiveTexture((GLenum)(GL_TEXTURE0 + unit));
    gl.BindTexture(GL_TEXTURE_2D, texture);
    return hn_check_gl("%s: unit %d, texture %u", operation, unit, texture);
}
