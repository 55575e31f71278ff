/* draw.c: draws of meshes and of buffers, in a state that is set anew for each. */
#include "internal.h"

static const hn_state at_start_of_pass = {
    .fill = GL_FILL,
    .cull = GL_BACK,
    .front = GL_CCW,
    .depth_test = 1,
    .depth_write = 1,
    .depth_function = GL_LESS,
};

static int check(const char *operation, const hn_call *call) {
    if (!call || call->program == 0)
        return hn_fail("%s: no %s", operation, call ? "program" : "call");
    if (call->mesh && call->mesh->context_id != hn_context_id())
        return hn_fail("%s: the mesh's context was closed", operation);
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_VERTEX_ATTRIBS, &limit);
    if (call->n_attributes < 0 || call->n_attributes > limit || (call->n_attributes > 0 && !call->attributes))
        return hn_fail("%s: %d attributes: the driver has %d", operation, call->n_attributes, limit);
    for (int i = 0; i < call->n_attributes; ++i)
        if (!call->mesh && call->attributes[i].buffer == 0)
            return hn_fail("%s: attribute %d reads a mesh, but there is none", operation, i);
    if (!call->mesh && call->n_vertices < 0)
        return hn_fail("%s: no mesh, and %d vertices", operation, call->n_vertices);
    return 0;
}

static void enable(GLenum capability, int on) {
    if (on)
        gl.Enable(capability);
    else
        gl.Disable(capability);
}

static void set_stencil(GLenum face, const hn_stencil *side, const hn_state *state) {
    gl.StencilFuncSeparate(face, side->function, state->stencil_reference, state->stencil_read_mask);
    gl.StencilOpSeparate(face, side->fail, side->depth_fail, side->pass);
}

static void set_state(const hn_state *state) {
    gl.PolygonMode(GL_FRONT_AND_BACK, state->fill);
    enable(GL_CULL_FACE, state->cull != GL_NONE);
    if (state->cull != GL_NONE)
        gl.CullFace(state->cull);
    gl.FrontFace(state->front);
    enable(GL_DEPTH_CLAMP, state->depth_clamp);
    enable(GL_DEPTH_TEST, state->depth_test);
    gl.DepthFunc(state->depth_function);
    gl.DepthMask(state->depth_write ? GL_TRUE : GL_FALSE);
    enable(GL_BLEND, state->blend);
    if (state->blend) {
        gl.BlendEquationSeparate(state->blend_functions[0], state->blend_functions[1]);
        gl.BlendFuncSeparate(state->blend_factors[0], state->blend_factors[1], state->blend_factors[2],
                             state->blend_factors[3]);
        gl.BlendColor(state->blend_color[0], state->blend_color[1], state->blend_color[2],
                      state->blend_color[3]);
    }
    enable(GL_STENCIL_TEST, state->stencil_test);
    if (state->stencil_test) {
        gl.StencilMask(state->stencil_write_mask);
        set_stencil(GL_FRONT, &state->stencil_front, state);
        set_stencil(GL_BACK, &state->stencil_back, state);
    }
}

static void set_attributes(const hn_call *call, size_t first_vertex) {
    for (GLuint i = 0; i < (GLuint)call->n_attributes; ++i) {
        const hn_attribute *attribute = &call->attributes[i];
        uint64_t offset = attribute->offset;
        if (attribute->buffer == 0)
            offset += first_vertex * sizeof(hn_vertex);
        gl.BindBuffer(GL_ARRAY_BUFFER, attribute->buffer ? attribute->buffer : call->mesh->vertex_buffer);
        gl.VertexAttribPointer(i, attribute->components, attribute->type, GL_FALSE, attribute->stride,
                               (const void *)(uintptr_t)offset);
        gl.VertexAttribDivisor(i, attribute->divisor);
    }
}

static void draw_part(const hn_call *call, const hn_part *part) {
    set_attributes(call, part->first_vertex);
    const void *first = (const void *)(part->first_index * sizeof(uint32_t));
    if (call->instanced)
        gl.DrawElementsInstanced(call->topology, (GLsizei)part->n_indices, GL_UNSIGNED_INT, first,
                                 call->instances);
    else
        gl.DrawElements(call->topology, (GLsizei)part->n_indices, GL_UNSIGNED_INT, first);
}

static void draw_vertices(const hn_call *call) {
    set_attributes(call, 0);
    if (call->instanced)
        gl.DrawArraysInstanced(call->topology, 0, call->n_vertices, call->instances);
    else
        gl.DrawArrays(call->topology, 0, call->n_vertices);
}

int hn_draw(hn_target *target, const hn_call *call) {
    const char *operation = "hn_draw";
    if (hn_target_use(operation, target) || check(operation, call))
        return -1;
    gl.UseProgram(call->program);
    /* Before drawing: a program refused leaves the one before it in use. */
    if (hn_check_gl("%s: program %u", operation, call->program))
        return -1;

    hn_write_everything();
    int width = 0, height = 0;
    hn_target_size(target, &width, &height);
    gl.Viewport(0, 0, width, height);
    set_state(call->state ? call->state : &at_start_of_pass);
    if (call->patch_vertices > 0 && gl.PatchParameteri)
        gl.PatchParameteri(GL_PATCH_VERTICES, call->patch_vertices);

    /* One of its own, so that no draw sees the attributes of another. */
    GLuint vertex_array = 0;
    gl.GenVertexArrays(1, &vertex_array);
    gl.BindVertexArray(vertex_array);
    for (int i = 0; i < call->n_attributes; ++i)
        gl.EnableVertexAttribArray((GLuint)i);
    if (call->mesh) {
        gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, call->mesh->index_buffer);
        for (size_t i = 0; i < call->mesh->n_parts; ++i)
            if (call->mesh->parts[i].n_indices > 0)
                draw_part(call, &call->mesh->parts[i]);
    } else {
        draw_vertices(call);
    }
    gl.BindVertexArray(0);
    gl.DeleteVertexArrays(1, &vertex_array);
    /* Nobody else expects lines, blending or a stencil. */
    set_state(&at_start_of_pass);
    return hn_check_gl("%s: program %u, topology 0x%04X", operation, call->program, call->topology);
}
