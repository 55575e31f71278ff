/* compute.c: runs a compute shader once for each element of arrays: the fast way to evaluate, where there is GL 4.3.
 *
 * Its results are those of the fragment stage bit for bit, but they are written where the caller wants them, by all of
 * the driver's threads: no target, no tiles, no readback.
 */
#include "internal.h"

enum { GROUP = 256, /* as in hn_compute_head() */ GROUPS_MAX = 65535 /* the fewest that GL 4.3 promises */ };

int hn_compute_available(void) {
    return hn_context_check("hn_compute_available") == 0 && gl.DispatchCompute != NULL;
}

size_t hn_compute_limit(uint32_t components) {
    GLint bytes = 0;
    if (hn_compute_available() && components > 0)
        gl.GetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    size_t elements = (size_t)GROUP * GROUPS_MAX;
    size_t held = components > 0 ? (size_t)bytes / (4 * components) : 0;
    return (held < elements ? held : elements) / 4 *
           4; /* so that every part of an array is aligned like the first */
}

int hn_compute(uint32_t program, const hn_input *inputs, int n_inputs, const hn_output *outputs,
               int n_outputs, size_t count, uint32_t each) {
    if (!hn_compute_available())
        return hn_fail("hn_compute: this context has no compute stage");
    if (hn_arrays_check(inputs, n_inputs, outputs, n_outputs, HN_COMPONENTS_MAX))
        return -1;
    if (each < 1)
        return hn_fail("hn_compute: %u elements an invocation", each);
    for (int k = 0; k < n_outputs; ++k)
        if (count > hn_compute_limit(outputs[k].components))
            return hn_fail("hn_compute: %zu elements of output %d, but at most %zu at a time", count, k,
                           hn_compute_limit(outputs[k].components));
    if (count == 0)
        return 0;

    gl.UseProgram(program);
    hn_bound_inputs bound;
    int failed = hn_inputs_bind(&bound, program, inputs, n_inputs);
    GLuint buffers[HN_OUTPUTS_MAX];
    int in_place[HN_OUTPUTS_MAX];
    gl.GenBuffers(n_outputs, buffers);
    for (int k = 0; k < n_outputs; ++k) {
        size_t size = count * outputs[k].components * sizeof(float);
        in_place[k] = hn_buffer_over(GL_SHADER_STORAGE_BUFFER, buffers[k], outputs[k].data, size, 0);
        gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint)k, buffers[k]);
    }
    gl.Uniform1i(gl.GetUniformLocation(program, "hn_count"), (GLint)count);
    if (!failed)
        failed = hn_check_gl("hn_compute: outputs of program %u", program);
    if (!failed) {
        size_t group = (size_t)GROUP * each;
        gl.DispatchCompute((GLuint)((count + group - 1) / group), 1, 1);
        gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    gl.Finish(); /* the caller may use or free pinned memory from here on */
    for (int k = 0; k < n_outputs; ++k) {
        if (!failed && !in_place[k]) {
            gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[k]);
            gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                                (GLsizeiptr)(count * outputs[k].components * sizeof(float)), outputs[k].data);
        }
        gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint)k, 0);
    }
    gl.DeleteBuffers(n_outputs, buffers);
    hn_inputs_release(&bound);
    gl.UseProgram(0);
    return failed ? -1 : hn_check_gl("hn_compute: program %u over %zu elements", program, count);
}

const char *hn_compute_head(void) {
    return "layout(local_size_x = 256) in;\n";
}
