/* mesh.c: meshes, from a model file through Assimp or from vertices at hand. */
#include "internal.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <stdlib.h>
#include <string.h>

enum { ALL_FIELDS = (1 << (HN_COLOR + 1)) - 1 };

/* A mesh in memory, on its way to the driver. */
typedef struct {
    hn_vertex *vertices;
    uint32_t *indices;
    hn_mesh *mesh; /* the counts so far, with the parts; no buffers yet */
} mesh_builder;

/* GL's sizes are signed: what does not fit there is as good as an overflow of size_t. */
static int too_many(size_t count, size_t size_of_one) {
    return count > (size_t)PTRDIFF_MAX / size_of_one;
}

static void upload(GLuint *buffer, size_t bytes, const void *data) {
    gl.GenBuffers(1, buffer);
    /* Not GL_ELEMENT_ARRAY_BUFFER, not even for indices: that binding belongs to a vertex array object. */
    gl.BindBuffer(GL_ARRAY_BUFFER, *buffer);
    gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
}

static int upload_mesh(const char *operation, hn_mesh *mesh, const hn_vertex *vertices,
                       const uint32_t *indices) {
    mesh->context_id = hn_context_id();
    upload(&mesh->vertex_buffer, mesh->n_vertices * sizeof *vertices, vertices);
    upload(&mesh->index_buffer, mesh->n_indices * sizeof *indices, indices);
    return hn_check_gl("%s: %zu vertices, %zu indices", operation, mesh->n_vertices, mesh->n_indices);
}

static hn_mesh *new_mesh(size_t n_parts) {
    hn_mesh *mesh = calloc(1, sizeof *mesh);
    hn_part *parts = mesh ? calloc(n_parts, sizeof *parts) : NULL;
    if (!parts) {
        free(mesh);
        return NULL;
    }
    mesh->parts = parts;
    mesh->fields = ALL_FIELDS;
    return mesh;
}

hn_mesh *hn_mesh_create(const hn_vertex *vertices, size_t n_vertices, const uint32_t *indices,
                        size_t n_indices) {
    const char *operation = "hn_mesh_create";
    if (hn_context_check(operation))
        return NULL;
    if (!indices)
        n_indices = n_vertices;
    if (!vertices || n_vertices == 0 || n_indices == 0) {
        hn_fail("%s: %zu vertices and %zu indices make no mesh", operation, vertices ? n_vertices : 0,
                n_indices);
        return NULL;
    }
    if (too_many(n_vertices, sizeof *vertices) || n_vertices - 1 > UINT32_MAX || n_indices > INT32_MAX) {
        hn_fail("%s: %zu vertices and %zu indices are too many", operation, n_vertices, n_indices);
        return NULL;
    }
    for (size_t i = 0; indices && i < n_indices; ++i)
        if (indices[i] >= n_vertices) {
            hn_fail("%s: index %zu is %u, but there are %zu vertices", operation, i, indices[i], n_vertices);
            return NULL;
        }
    hn_mesh *mesh = new_mesh(1);
    uint32_t *in_order = indices ? NULL : malloc(n_indices * sizeof *in_order);
    if (!mesh || (!indices && !in_order)) {
        free(in_order);
        hn_mesh_delete(mesh);
        hn_fail("%s: no memory for %zu vertices", operation, n_vertices);
        return NULL;
    }
    for (size_t i = 0; in_order && i < n_indices; ++i)
        in_order[i] = (uint32_t)i;
    mesh->n_parts = 1;
    mesh->parts[0] = (hn_part){0, n_vertices, 0, n_indices};
    mesh->n_vertices = n_vertices;
    mesh->n_indices = n_indices;
    if (upload_mesh(operation, mesh, vertices, indices ? indices : in_order)) {
        hn_mesh_delete(mesh);
        mesh = NULL;
    }
    free(in_order);
    return mesh;
}

/* Does something for each mesh of a scene in node order, the order in which SHADERed draws them: a node's
 * meshes, then its children. A mesh that two nodes refer to comes twice. Stops at the first that is refused
 * (not 0). */
static int walk(const struct aiScene *scene, const struct aiNode *node,
                int (*visit)(mesh_builder *, const struct aiMesh *), mesh_builder *builder) {
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
        if (node->mMeshes[i] >= scene->mNumMeshes)
            return hn_fail("a node refers to mesh %u of %u", node->mMeshes[i], scene->mNumMeshes);
        if (visit(builder, scene->mMeshes[node->mMeshes[i]]))
            return -1;
    }
    for (unsigned i = 0; i < node->mNumChildren; ++i)
        if (walk(scene, node->mChildren[i], visit, builder))
            return -1;
    return 0;
}

static int count_part(mesh_builder *builder, const struct aiMesh *from) {
    hn_mesh *mesh = builder->mesh;
    size_t n_indices = 0;
    for (unsigned i = 0; i < from->mNumFaces; ++i) {
        for (unsigned k = 0; k < from->mFaces[i].mNumIndices; ++k)
            if (from->mFaces[i].mIndices[k] >= from->mNumVertices)
                return hn_fail("face %u has vertex %u of %u", i, from->mFaces[i].mIndices[k],
                               from->mNumVertices);
        /* Triangulate leaves points and lines as they are; SHADERed draws their vertices as triangles. */
        mesh->n_stray_faces += from->mFaces[i].mNumIndices != 3;
        n_indices += from->mFaces[i].mNumIndices;
    }
    if (n_indices > INT32_MAX || too_many(mesh->n_indices + n_indices, sizeof(uint32_t)) ||
        too_many(mesh->n_vertices + from->mNumVertices, sizeof(hn_vertex)))
        return hn_fail("too many vertices");
    mesh->n_vertices += from->mNumVertices;
    mesh->n_indices += n_indices;
    mesh->n_parts += 1;
    return 0;
}

static void copy3(float to[3], const struct aiVector3D *from) {
    to[0] = from->x;
    to[1] = from->y;
    to[2] = from->z;
}

static int copy_part(mesh_builder *builder, const struct aiMesh *from) {
    hn_mesh *mesh = builder->mesh;
    hn_part *part = &mesh->parts[mesh->n_parts++];
    *part = (hn_part){mesh->n_vertices, from->mNumVertices, mesh->n_indices, 0};

    const struct aiVector3D *texcoords = from->mTextureCoords[0];
    const struct aiColor4D *colors = from->mColors[0];
    for (unsigned i = 0; i < from->mNumVertices; ++i) {
        hn_vertex *to = &builder->vertices[part->first_vertex + i];
        *to = (hn_vertex){.color = {1, 1, 1, 1}};
        copy3(to->position, &from->mVertices[i]);
        if (from->mNormals)
            copy3(to->normal, &from->mNormals[i]);
        if (texcoords) {
            to->texcoord[0] = texcoords[i].x;
            to->texcoord[1] = texcoords[i].y;
        }
        if (from->mTangents)
            copy3(to->tangent, &from->mTangents[i]);
        if (from->mBitangents)
            copy3(to->bitangent, &from->mBitangents[i]);
        if (colors)
            memcpy(to->color, (const float[]){colors[i].r, colors[i].g, colors[i].b, colors[i].a},
                   sizeof to->color);
    }
    for (unsigned i = 0; i < from->mNumFaces; ++i)
        for (unsigned k = 0; k < from->mFaces[i].mNumIndices; ++k)
            builder->indices[part->first_index + part->n_indices++] = from->mFaces[i].mIndices[k];

    mesh->n_vertices += part->n_vertices;
    mesh->n_indices += part->n_indices;
    const uint32_t has[] = {
        [HN_POSITION] = from->mVertices != NULL,    [HN_NORMAL] = from->mNormals != NULL,
        [HN_TEXCOORD] = texcoords != NULL,          [HN_TANGENT] = from->mTangents != NULL,
        [HN_BITANGENT] = from->mBitangents != NULL, [HN_COLOR] = colors != NULL};
    for (unsigned field = HN_POSITION; field <= HN_COLOR; ++field)
        if (!has[field])
            mesh->fields &= ~(1u << field);
    return 0;
}

/* Fills a mesh from a scene; NULL with the reason, without the file's name, in hn_error(). */
static hn_mesh *from_scene(const struct aiScene *scene) {
    hn_mesh counts = {0};
    mesh_builder builder = {.mesh = &counts};
    if (walk(scene, scene->mRootNode, count_part, &builder))
        return NULL;
    if (counts.n_indices == 0) {
        hn_fail(counts.n_parts == 0 ? "the file has no meshes" : "the file has no faces");
        return NULL;
    }
    builder.mesh = new_mesh(counts.n_parts);
    builder.vertices = malloc(counts.n_vertices * sizeof *builder.vertices);
    builder.indices = malloc(counts.n_indices * sizeof *builder.indices);
    int failed = 1;
    if (!builder.mesh || !builder.vertices || !builder.indices) {
        hn_fail("no memory for %zu vertices", counts.n_vertices);
    } else {
        builder.mesh->n_stray_faces = counts.n_stray_faces;
        failed = walk(scene, scene->mRootNode, copy_part, &builder) ||
                 upload_mesh("upload", builder.mesh, builder.vertices, builder.indices);
    }
    free(builder.vertices);
    free(builder.indices);
    if (failed) {
        hn_mesh_delete(builder.mesh);
        return NULL;
    }
    return builder.mesh;
}

hn_mesh *hn_mesh_load(const char *path) {
    const char *operation = "hn_mesh_load";
    if (hn_context_check(operation))
        return NULL;
    if (!path) {
        hn_fail("%s: no path", operation);
        return NULL;
    }
    const struct aiScene *scene = aiImportFile(path, aiProcess_Triangulate | aiProcess_FlipUVs);
    if (!scene) {
        hn_fail("%s: %s: %s", operation, path, aiGetErrorString());
        return NULL;
    }
    hn_mesh *mesh = NULL;
    if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) || !scene->mRootNode)
        hn_fail("%s: %s: the file has no complete scene", operation, path);
    else if (!(mesh = from_scene(scene)))
        hn_fail("%s: %s: %s", operation, path, hn_error());
    aiReleaseImport(scene);
    return mesh;
}

void hn_mesh_delete(hn_mesh *mesh) {
    if (!mesh)
        return;
    /* With its context gone the buffers are gone too, and their names may be another's. */
    if (mesh->context_id != 0 && mesh->context_id == hn_context_id() && !hn_context_check("hn_mesh_delete")) {
        gl.DeleteBuffers(1, &mesh->vertex_buffer);
        gl.DeleteBuffers(1, &mesh->index_buffer);
        hn_check_gl("hn_mesh_delete");
    }
    free(mesh->parts);
    free(mesh);
}

uint32_t hn_mesh_fields(const hn_mesh *mesh) {
    return mesh ? mesh->fields : 0;
}

size_t hn_mesh_vertex_count(const hn_mesh *mesh) {
    return mesh ? mesh->n_vertices : 0;
}

size_t hn_mesh_index_count(const hn_mesh *mesh) {
    return mesh ? mesh->n_indices : 0;
}

size_t hn_mesh_stray_faces(const hn_mesh *mesh) {
    return mesh ? mesh->n_stray_faces : 0;
}

int hn_mesh_read(const hn_mesh *mesh, hn_vertex *vertices, uint32_t *indices) {
    const char *operation = "hn_mesh_read";
    if (hn_context_check(operation))
        return -1;
    if (!mesh || !vertices || !indices || mesh->context_id != hn_context_id())
        return hn_fail("%s: no mesh of this context, or nowhere to copy it to", operation);
    gl.BindBuffer(GL_ARRAY_BUFFER, mesh->vertex_buffer);
    gl.GetBufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(mesh->n_vertices * sizeof *vertices), vertices);
    gl.BindBuffer(GL_ARRAY_BUFFER, mesh->index_buffer);
    gl.GetBufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(mesh->n_indices * sizeof *indices), indices);
    if (hn_check_gl("%s", operation))
        return -1;
    for (size_t p = 0; p < mesh->n_parts; ++p)
        for (size_t i = 0; i < mesh->parts[p].n_indices; ++i)
            indices[mesh->parts[p].first_index + i] += (uint32_t)mesh->parts[p].first_vertex;
    return 0;
}
