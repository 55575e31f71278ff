/* arrays.c: arrays that lie in the caller's memory as buffers of GL, without a copy where the driver can do that.
 *
 * Fetching costs more than the arithmetic of a whole reflection model. So inputs are buffer textures over the caller's
 * own memory, and a compute stage's outputs are written straight into it (GL_AMD_pinned_memory); what the driver
 * cannot pin, or what is not aligned for it, is copied.
 */
#include "internal.h"

#include <GL/glext.h>

enum { PIN_ALIGNMENT = 16 }; /* of the widest texel, RGBA32F: the driver may load it by one instruction */

/* Whether memory can be used where it lies; asked once a context, for the driver lists hundreds of extensions. */
static int can_pin(void) {
    static uint32_t context_id;
    static int answer;
    if (context_id != hn_context_id()) {
        context_id = hn_context_id();
        answer = hn_gl_has("GL_AMD_pinned_memory");
    }
    return answer;
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

int hn_arrays_check(const hn_input *inputs, int n_inputs, const hn_output *outputs, int n_outputs,
                    uint32_t components_max) {
    GLint units = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    units = units < HN_INPUTS_MAX ? units : HN_INPUTS_MAX;
    if (n_inputs < 0 || n_inputs > units)
        return hn_fail("hn_evaluate: %d inputs, but this driver takes at most %d", n_inputs, units);
    if (n_outputs < 1 || n_outputs > HN_OUTPUTS_MAX)
        return hn_fail("hn_evaluate: %d outputs, but there can be 1 ... %d", n_outputs, HN_OUTPUTS_MAX);
    for (int k = 0; k < n_inputs; ++k) {
        const hn_input *input = &inputs[k];
        if (!texel_format(input->base, input->components))
            return hn_fail("hn_evaluate: input %s: %u components of type 0x%x are no texel", input->name,
                           input->components, input->base);
        if (input->count == 0 || input->count > hn_evaluate_limit())
            return hn_fail("hn_evaluate: input %s: %zu texels, but 1 ... %zu can be", input->name,
                           input->count, hn_evaluate_limit());
    }
    for (int k = 0; k < n_outputs; ++k)
        if (outputs[k].components < 1 || outputs[k].components > components_max)
            return hn_fail("hn_evaluate: output %d: %u components, but 1 ... %u can be", k,
                           outputs[k].components, components_max);
    return 0;
}

int hn_buffer_over(uint32_t binding, uint32_t buffer, const void *data, size_t size, int input) {
    if (can_pin() && (uintptr_t)data % PIN_ALIGNMENT == 0) {
        gl.BindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, buffer);
        gl.BufferData(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, (GLsizeiptr)size, data, GL_STREAM_COPY);
        gl.BindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, 0);
        return 1;
    }
    gl.BindBuffer(binding, buffer);
    gl.BufferData(binding, (GLsizeiptr)size, input ? data : NULL, input ? GL_STREAM_DRAW : GL_STREAM_READ);
    gl.BindBuffer(binding, 0);
    return 0;
}

int hn_inputs_bind(hn_bound_inputs *bound, uint32_t program, const hn_input *inputs, int n_inputs) {
    bound->n = n_inputs;
    gl.GenBuffers(n_inputs, bound->buffers);
    gl.GenTextures(n_inputs, bound->textures);
    for (int k = 0; k < n_inputs; ++k) {
        const hn_input *input = &inputs[k];
        GLint location = gl.GetUniformLocation(program, input->name);
        if (location < 0)
            continue; /* the program does not read it */
        hn_buffer_over(GL_TEXTURE_BUFFER, bound->buffers[k], input->data,
                       input->count * input->components * 4, 1);
        gl.ActiveTexture(GL_TEXTURE0 + (GLenum)k);
        gl.BindTexture(GL_TEXTURE_BUFFER, bound->textures[k]);
        gl.TexBuffer(GL_TEXTURE_BUFFER, texel_format(input->base, input->components), bound->buffers[k]);
        gl.Uniform1i(location, k);
    }
    return hn_check_gl("hn_evaluate: inputs of program %u", program);
}

void hn_inputs_release(const hn_bound_inputs *bound) {
    gl.DeleteTextures(bound->n, bound->textures);
    gl.DeleteBuffers(bound->n, bound->buffers);
}

size_t hn_evaluate_limit(void) {
    GLint texels = 0;
    if (hn_context_check("hn_evaluate_limit") == 0)
        gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    return (size_t)texels;
}
