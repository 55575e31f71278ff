/* buffer.c: buffers for vertices and storage blocks, and the compute passes that fill them. */
#include "internal.h"

#include <stdlib.h>

uint32_t hn_buffer_create(size_t size, const void *data) {
    const char *operation = "hn_buffer_create";
    if (hn_context_check(operation))
        return 0;
    if (size == 0 || size > HN_IMAGE_BYTES_MAX) {
        hn_fail("%s: %zu bytes: 1 to %zu work", operation, size, HN_IMAGE_BYTES_MAX);
        return 0;
    }
    /* GL leaves new memory to chance; a picture must not depend on it. */
    void *zeros = data ? NULL : calloc(size, 1);
    if (!data && !zeros) {
        hn_fail("%s: no memory for %zu bytes", operation, size);
        return 0;
    }
    GLuint buffer = 0;
    gl.GenBuffers(1, &buffer);
    gl.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size, data ? data : zeros, GL_DYNAMIC_DRAW);
    gl.BindBuffer(GL_ARRAY_BUFFER, 0);
    free(zeros);
    if (hn_check_gl("%s: %zu bytes", operation, size)) {
        gl.DeleteBuffers(1, &buffer);
        return 0;
    }
    return buffer;
}

void hn_buffer_delete(uint32_t buffer) {
    if (buffer == 0 || hn_context_check("hn_buffer_delete"))
        return;
    gl.DeleteBuffers(1, &buffer);
    hn_check_gl("hn_buffer_delete: buffer %u", buffer);
}

int hn_buffer_bind(int binding, uint32_t buffer) {
    const char *operation = "hn_buffer_bind";
    if (hn_context_check(operation))
        return -1;
    if (!hn_compute_available())
        return hn_fail("%s: this context has no shader storage buffers", operation);
    if (binding < 0)
        return hn_fail("%s: binding %d", operation, binding);
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint)binding, buffer);
    return hn_check_gl("%s: binding %d, buffer %u", operation, binding, buffer);
}

int hn_buffer_read(uint32_t buffer, size_t size, void *data) {
    const char *operation = "hn_buffer_read";
    if (hn_context_check(operation))
        return -1;
    if (!data)
        return hn_fail("%s: nowhere to put the bytes", operation);
    gl.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl.GetBufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)size, data);
    gl.BindBuffer(GL_ARRAY_BUFFER, 0);
    return hn_check_gl("%s: buffer %u, %zu bytes", operation, buffer, size);
}

int hn_dispatch(uint32_t program, uint32_t x, uint32_t y, uint32_t z) {
    const char *operation = "hn_dispatch";
    if (hn_context_check(operation))
        return -1;
    if (!hn_compute_available())
        return hn_fail("%s: this context has no compute stage", operation);
    gl.UseProgram(program);
    if (hn_check_gl("%s: program %u", operation, program))
        return -1;
    gl.DispatchCompute(x, y, z);
    gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
    return hn_check_gl("%s: program %u, %u x %u x %u groups", operation, program, x, y, z);
}
