/* test_mesh.c: meshes from files and from vertices. */
#include "check.h"

#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

/* Two meshes, "red" and "green" by their normals, that cover the target at the same depth. The scene has
 * green, red, green in node order: against the order of the meshes, and with transforms, to be ignored. */
static const char gltf[] =
    "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':["
    "{'children':[1,2]},{'mesh':1,'translation':[50,0,0]},{'mesh':0,'children':[3]},{'mesh':1,'scale':[0.1,1,"
    "1]}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'indices':3}]},"
    "{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2},'indices':3}]}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3','min':[-1,-1,0],'max':[3,3,0]}"
    ","
    "{'bufferView':1,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':2,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':3,'componentType':5123,'count':3,'type':'SCALAR'}],"
    "'bufferViews':[{'buffer':0,'byteOffset':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':36},"
    "{'buffer':0,'byteOffset':72,'byteLength':36},{'buffer':0,'byteOffset':108,'byteLength':6}],"
    "'buffers':[{'byteLength':114,'uri':'data:application/octet-stream;base64,"
    "AACAvwAAgL8AAAAAAABAQAAAgL8AAAAAAACAvwAAQEAAAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAA"
    "gD8A"
    "AAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIA'}]}";

static char folder[256], path[300];

/* A file in the tests' own folder with this text, ' standing for "; its path. */
static const char *file_with(const char *name, const char *text) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    for (; file && *text; ++text)
        putc(*text == '\'' ? '"' : *text, file);
    if (file)
        fclose(file);
    return path;
}

static hn_mesh *load(const char *name, const char *text) {
    hn_mesh *mesh = hn_mesh_load(file_with(name, text));
    remove(path);
    return mesh;
}

/* The middle pixel of the mesh drawn with one field as its colour. */
static int draw_field(const hn_mesh *mesh, hn_field field, float rgba[4]) {
    const hn_field fields[] = {HN_POSITION, field};
    uint32_t program =
        hn_program_create("#version 330\nlayout(location = 0) in vec3 position;\nlayout(location = 1) in "
                          "vec4 value;\nout vec4 v;\n"
                          "void main() { v = value; gl_Position = vec4(position, 1.0); }\n",
                          "#version 330\nin vec4 v;\nout vec4 color;\nvoid main() { color = v; }\n");
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    const float blank[4] = {0};
    int result = clear(target, blank) || draw_fields(target, program, mesh, fields, 2, NULL) ||
                 hn_target_read_floats(target, rgba);
    hn_target_delete(target);
    hn_program_delete(program);
    return result;
}

static int is(const float a[4], float x, float y, float z, float w) {
    return a[0] == x && a[1] == y && a[2] == z && a[3] == w;
}

static void test_obj(void) {
    /* A square of one face, without normals: Triangulate makes two triangles; FlipUVs makes v 1 - v. */
    hn_mesh *mesh = load("square.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0.25 0.25\n"
                                       "f 1/1 2/1 3/1 4/1\n");
    CHECK(mesh != NULL);
    CHECK(hn_mesh_index_count(mesh) == 6);
    CHECK(hn_mesh_vertex_count(mesh) >= 4);
    CHECK(hn_mesh_fields(mesh) == ((1u << HN_POSITION) | (1u << HN_TEXCOORD)));
    float rgba[4] = {0};
    CHECK(draw_field(mesh, HN_TEXCOORD, rgba) == 0 && is(rgba, 0.25f, 0.75f, 0, 1));
    /* What the file lacks is 0, colour is 1. */
    CHECK(draw_field(mesh, HN_NORMAL, rgba) == 0 && is(rgba, 0, 0, 0, 1));
    CHECK(draw_field(mesh, HN_TANGENT, rgba) == 0 && is(rgba, 0, 0, 0, 1));
    CHECK(draw_field(mesh, HN_BITANGENT, rgba) == 0 && is(rgba, 0, 0, 0, 1));
    CHECK(draw_field(mesh, HN_COLOR, rgba) == 0 && is(rgba, 1, 1, 1, 1));
    hn_mesh_delete(mesh);
}

static void test_node_order(void) {
    hn_mesh *mesh = load("nodes.gltf", gltf);
    CHECK(mesh != NULL);
    CHECK(hn_mesh_vertex_count(mesh) == 9 && hn_mesh_index_count(mesh) == 9);
    CHECK(hn_mesh_fields(mesh) == ((1u << HN_POSITION) | (1u << HN_NORMAL)));
    /* At equal depth the first that is drawn stays. */
    float rgba[4] = {0};
    CHECK(draw_field(mesh, HN_NORMAL, rgba) == 0 && is(rgba, 0, 1, 0, 1));
    /* Copied back: the parts follow one another, and the indices of each go on where the part before ended. */
    hn_vertex vertices[9] = {0};
    uint32_t indices[9] = {0};
    CHECK(hn_mesh_read(mesh, vertices, indices) == 0);
    for (uint32_t i = 0; i < 9; ++i)
        CHECK(indices[i] == i && vertices[i].position[0] == (i % 3 == 1 ? 3 : -1) &&
              vertices[i].normal[0] == (i / 3 == 1) && vertices[i].normal[1] == (i / 3 != 1));
    CHECK_FAILS(hn_mesh_read(mesh, vertices, NULL) != 0, "hn_mesh_read: no mesh");
    CHECK_FAILS(hn_mesh_read(NULL, vertices, indices) != 0, "hn_mesh_read: no mesh");
    hn_mesh_delete(mesh);
}

/* Lines stay in the mesh, as vertices for triangles, and are counted. */
static void test_stray_faces(void) {
    hn_mesh *mesh = load("lines.obj", "v -1 -1 0\nv 3 -1 0\nv -1 3 0\nl 1 2\nl 3 1\n");
    CHECK(hn_mesh_index_count(mesh) == 4 && hn_mesh_stray_faces(mesh) == 2);
    float rgba[4] = {0};
    CHECK(draw_field(mesh, HN_COLOR, rgba) == 0 && is(rgba, 1, 1, 1, 1));
    hn_mesh_delete(mesh);
    CHECK(hn_mesh_stray_faces(NULL) == 0);
}

static void test_bad_files(void) {
    CHECK_FAILS(!hn_mesh_load("no/such/file.obj"), "hn_mesh_load: no/such/file.obj: Unable to open file");
    CHECK_FAILS(!hn_mesh_load(NULL), "no path");
    CHECK_FAILS(!load("damaged.gltf", "{'asset':{'version':'2.0'},'scene':0,"), "damaged.gltf: ");
    CHECK_FAILS(!load("damaged.glb", "glTF\x02"), "damaged.glb: ");
    CHECK_FAILS(!load("what.xyz", "1 2 3\n"), "what.xyz: No suitable reader found");
    CHECK_FAILS(!load("empty.obj", ""), "empty.obj: ");
    CHECK_FAILS(
        !load("empty.gltf", "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{}]}"),
        "empty.gltf: ");
    /* An accessor past the end of its buffer, and an index past the vertices. */
    char text[sizeof gltf];
    strcpy(text, gltf);
    memcpy(strstr(text, "'byteLength':6"), "'byteLength':9", 14);
    hn_mesh *mesh = load("beyond.gltf", text);
    CHECK_FAILS(!mesh, "beyond.gltf: ");
    strcpy(text, gltf);
    memcpy(strstr(text, "BAAIA"), "B/wIA", 5);
    mesh = load("index.gltf", text);
    CHECK_FAILS(!mesh, "index.gltf: ");
}

static void test_create(void) {
    /* A square: as two triangles of six vertices, and by indices of four. */
    const hn_vertex corner[] = {{.position = {-1, -1, 0}, .color = {1, 2, 3, 4}},
                                {.position = {1, -1, 0}, .color = {1, 2, 3, 4}},
                                {.position = {1, 1, 0}, .color = {1, 2, 3, 4}},
                                {.position = {-1, 1, 0}, .color = {1, 2, 3, 4}}};
    const hn_vertex in_order[] = {corner[0], corner[1], corner[2], corner[0], corner[2], corner[3]};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3}, beyond[] = {0, 1, 4};
    hn_mesh *mesh = hn_mesh_create(in_order, 6, NULL, 0);
    float rgba[4] = {0};
    CHECK(hn_mesh_vertex_count(mesh) == 6 && hn_mesh_index_count(mesh) == 6 && hn_mesh_fields(mesh) == 0x3F);
    CHECK(draw_field(mesh, HN_COLOR, rgba) == 0 && is(rgba, 1, 2, 3, 4));
    hn_mesh_delete(mesh);
    mesh = hn_mesh_create(corner, 4, indices, 6);
    CHECK(hn_mesh_vertex_count(mesh) == 4 && hn_mesh_index_count(mesh) == 6);
    CHECK(draw_field(mesh, HN_COLOR, rgba) == 0 && is(rgba, 1, 2, 3, 4));
    hn_mesh_delete(mesh);

    CHECK_FAILS(!hn_mesh_create(NULL, 3, NULL, 0), "make no mesh");
    CHECK_FAILS(!hn_mesh_create(corner, 0, NULL, 0), "make no mesh");
    CHECK_FAILS(!hn_mesh_create(corner, 4, indices, 0), "make no mesh");
    CHECK_FAILS(!hn_mesh_create(corner, 4, beyond, 3), "index 2 is 4, but there are 4 vertices");
    CHECK_FAILS(!hn_mesh_create(corner, SIZE_MAX / 3 * 3, NULL, 0), "too many");
    CHECK_FAILS(!hn_mesh_create(corner, SIZE_MAX, indices, 3), "too many");
    CHECK_FAILS(!hn_mesh_create(corner, 4, indices, SIZE_MAX / 3 * 3), "too many");
    CHECK(hn_mesh_fields(NULL) == 0 && hn_mesh_vertex_count(NULL) == 0 && hn_mesh_index_count(NULL) == 0);
}

void test_mesh(void) {
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/harness_test_XXXXXX", temporary ? temporary : P_tmpdir);
    CHECK(mkdtemp(folder) != NULL);
    test_obj();
    test_node_order();
    test_stray_faces();
    test_bad_files();
    test_create();
    CHECK(rmdir(folder) == 0);
}
