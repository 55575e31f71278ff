/* test_glsl.c: glslang's checks, preprocessor, tree and SPIR-V. */
#include "check.h"

#include <stdlib.h>

#define HEAD "#version 330\n"

static void test_version(void) {
    int major = 0, minor = -1, patch = -1;
    CHECK(sscanf(hn_glsl_version(), "%d.%d.%d", &major, &minor, &patch) == 3);
    CHECK(major >= 11 && minor >= 0 && patch >= 0);
}

static void test_check(void) {
    const char *good = HEAD "out vec4 color;\nvoid main() { color = vec4(1.0); }\n";
    CHECK(hn_glsl_check(HN_FRAGMENT, good, 0) == 0);
    CHECK(hn_glsl_check(HN_FRAGMENT, good, 1) == 0);
    CHECK(hn_glsl_check(HN_VERTEX,
                        HEAD "in vec3 p;\nuniform mat4 m;\nout vec3 q;\n"
                             "void main() { q = p; gl_Position = m * vec4(p, 1.0); }\n",
                        1) == 0);
    CHECK(hn_glsl_check(HN_FRAGMENT, "#version 450\nvoid main() {}\n", 1) == 0);
    CHECK(hn_glsl_check(HN_FRAGMENT, HEAD "#extension GL_GOOGLE_include_directive : enable\nvoid main() {}\n",
                        1) == 0);

    /* All errors at once, each with its line. */
    const char *bad = HEAD "float f() { return a; }\nfloat g() { return b; }\nvoid main() { f(1.0); }\n";
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, bad, 0) == -1, "ERROR: 0:2: 'a' : undeclared identifier");
    CHECK(strstr(hn_error(), "ERROR: 0:3: 'b' : undeclared identifier"));
    CHECK(strstr(hn_error(), "ERROR: 0:4: 'f' : no matching overloaded function found"));
    CHECK(strncmp(hn_error(), "ERROR: ", 7) == 0);
    CHECK_FAILS(hn_glsl_check(HN_VERTEX, bad, 0) == -1, "ERROR: 0:2:");
    CHECK_FAILS(hn_glsl_check(HN_VERTEX, HEAD "void main() { discard; }\n", 0) == -1, "ERROR: 0:2:");
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, HEAD "#error no\nvoid main() {}\n", 0) == -1,
                "ERROR: 0:2: '#error' : no");

    /* Lines are those of the text, below macros and comments of several lines too. */
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT,
                              "#version 420\n#define F(x) \\\n x\n/*\n*/ float g = F(\n1.0);\nfloat f = a;\n",
                              0) == -1,
                "ERROR: 0:7: 'a'");
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, HEAD "#line 70 \"shaders/a.glsl\"\nfloat f = a;\n", 0) == -1,
                "0:");

    /* SPIR-V is stricter. */
    const char *no_body = HEAD "float f();\nout vec4 color;\nvoid main() { color = vec4(f()); }\n";
    CHECK(hn_glsl_check(HN_FRAGMENT, no_body, 0) == 0);
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, no_body, 1) == -1, "No function definition (body) found");
    const char *block = HEAD "uniform B { vec4 b; };\nout vec4 color;\nvoid main() { color = b; }\n";
    CHECK(hn_glsl_check(HN_FRAGMENT, block, 0) == 0);
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, block, 1) == -1, "require layout(binding=X)");
    CHECK(hn_glsl_check(HN_FRAGMENT, HEAD "float f;\n", 0) == 0);
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, HEAD "float f;\n", 1) == -1, "Missing entry point");

    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, NULL, 0) == -1, "hn_glsl_check: no text");
    CHECK_FAILS(hn_glsl_check((hn_stage)7, good, 0) == -1, "no stage 7");
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, "", 1) == -1, "ERROR");
}

/* A message is never cut short: glslang writes a line for each of thousands of errors. */
static void test_long_message(void) {
    enum { ERRORS = 2000, LINE = 32 };
    char *text = malloc(ERRORS * LINE + sizeof HEAD);
    char *end = text + sprintf(text, HEAD);
    for (int i = 0; i < ERRORS; ++i)
        end += sprintf(end, "float f%d = x%d;\n", i, i);
    CHECK_FAILS(hn_glsl_check(HN_FRAGMENT, text, 0) == -1, "ERROR: 0:2001: 'x1999'");
    CHECK(strlen(hn_error()) > 64 * 1024);
    free(text);
}

/* 1 when line `number`, from 1, of the text contains `part`. */
static int line_has(const char *text, int number, const char *part) {
    while (text && --number > 0) {
        text = strchr(text, '\n');
        text = text ? text + 1 : NULL;
    }
    const char *found = text ? strstr(text, part) : NULL;
    return found && (size_t)(found - text) < strcspn(text, "\n");
}

/* Each `int lineN;` of a text stands on its line N of the output, whatever comes before it. */
static void test_preprocess_lines(void) {
    static const char *const lines[] = {
        /*  1 */ "// a comment before the version",
        /*  2 */ "#version 450 core",
        /*  3 */ "#ifdef GL_GOOGLE_include_directive",
        /*  4 */ "#extension GL_GOOGLE_include_directive : enable",
        /*  5 */ "#endif",
        /*  6 */ "#define SUM(a, b) ((a) + \\",
        /*  7 */ "    (b)) // a comment",
        /*  8 */ "#define ALIAS SUM",
        /*  9 */ "#define PASTE(a, b) a##b",
        /* 10 */ "int line10; /* a block",
        /* 11 */ "",
        /* 12 */ "comment */ int line12;",
        /* 13 */ "int sum = SUM(1,",
        /* 14 */ "    SUM(2, // a comment among arguments",
        /* 15 */ "        3)); int line15;",
        /* 16 */ "#if defined(NOT) && \\",
        /* 17 */ "    NOT > 1",
        /* 18 */ "int never;",
        /* 19 */ "/* in a false branch",
        /* 20 */ "#endif */",
        /* 21 */ "#elif 1",
        /* 22 */ "int line22;",
        /* 23 */ "#else",
        /* 24 */ "#error not here",
        /* 25 */ "#endif",
        /* 26 */ "int continued \\",
        /* 27 */ "    = 1; int line27;",
        /* 28 */ "int name = ALIAS",
        /* 29 */ "    (1,",
        /* 30 */ "     2); int line30;",
        /* 31 */ "int PASTE(li,",
        /* 32 */ "    ne32);",
        /* 33 */ "#undef SUM",
        /* 34 */ "#pragma optimize(on)",
        /* 35 */ "int own = __LINE__;",
        /* 36 */ "// a comment that goes on \\",
        /* 37 */ "int inside_the_comment;",
        /* 38 */ "",
        /* 39 */ "\t#  if 0",
        /* 40 */ "\t#  endif",
        /* 41 */ "int line41; // the last, without a newline",
    };
    enum { N = sizeof lines / sizeof *lines };
    static const int marked[] = {10, 12, 15, 22, 27, 30, 32, 41};
    for (int crlf = 0; crlf < 2; ++crlf) {
        char text[4096] = "";
        for (int i = 0; i < N; ++i) {
            strcat(text, lines[i]);
            strcat(text, i + 1 == N ? "" : crlf ? "\r\n" : "\n");
        }
        char *out = hn_glsl_preprocess(HN_FRAGMENT, text);
        CHECK(out != NULL);
        for (size_t i = 0; out && i < sizeof marked / sizeof *marked; ++i) {
            char name[16];
            sprintf(name, "line%d", marked[i]);
            CHECK(line_has(out, marked[i], name));
        }
        CHECK(line_has(out, 2, "#version 450 core"));
        CHECK(line_has(out, 4, "#extension GL_GOOGLE_include_directive : enable"));
        CHECK(line_has(out, 13, "int sum ="));
        CHECK(line_has(out, 15, "((1)+(((2)+(3))))"));
        CHECK(line_has(out, 34, "#pragma optimize(on)"));
        CHECK(line_has(out, 35, "own = 35"));
        CHECK(out && !strstr(out, "never") && !strstr(out, "comment") && !strstr(out, "#line"));
        hn_free(out);
    }
}

static void test_preprocess(void) {
    test_preprocess_lines();
    /* For the driver: SPIR-V's macros are not defined. */
    char *out = hn_glsl_preprocess(HN_VERTEX, HEAD "#ifdef GL_SPIRV\nint spirv;\n#endif\nint x = y;\n");
    CHECK(out && !strstr(out, "spirv") && line_has(out, 5, "int x = y;"));
    hn_free(out);

    CHECK_FAILS(!hn_glsl_preprocess(HN_FRAGMENT, HEAD "#if 1\n"), "missing #endif");
    CHECK_FAILS(!hn_glsl_preprocess(HN_FRAGMENT, HEAD "\n#error why not\n"),
                "ERROR: 0:3: '#error' : why not");
    CHECK_FAILS(!hn_glsl_preprocess(HN_FRAGMENT, HEAD "#define F(x) x\nfloat f = F(1, 2);\n"), "ERROR: 0:3:");
    CHECK_FAILS(!hn_glsl_preprocess(HN_FRAGMENT, HEAD "#include \"a.glsl\"\n"), "#include");
    /* As the standard has it, continued lines are not in GLSL 330. */
    CHECK_FAILS(!hn_glsl_preprocess(HN_FRAGMENT, HEAD "int i \\\n= 1;\n"), "ERROR: 0:2: 'line continuation'");
    CHECK_FAILS(!hn_glsl_preprocess(HN_FRAGMENT, NULL), "hn_glsl_preprocess: no text");
}

static void test_tree(void) {
    const char *text = HEAD "#extension GL_GOOGLE_include_directive : enable\n"
                            "struct Material { vec3 albedo; float roughness; };\n"
                            "vec3 shade(const in vec3 l, Material m, out float d, inout int i)\n"
                            "{ d = 1.0; return l * m.roughness; }\n"
                            "float uncalled(mat3 t[2]) { return t[0][1].x; }\n";
    char *tree = hn_glsl_tree(HN_FRAGMENT, text);
    CHECK(tree != NULL);
    CHECK(tree && strstr(tree, "Function Definition: shade("));
    CHECK(tree && strstr(tree, "Function Definition: uncalled("));
    CHECK(tree && strstr(tree, "'l' ( const (read only) 3-component vector of float)"));
    CHECK(tree && strstr(tree, "'d' ( out float)"));
    CHECK(tree && strstr(tree, "'i' ( inout int)"));
    CHECK(tree &&
          strstr(tree,
                 "'m' ( in structure{ global 3-component vector of float albedo,  global float roughness})"));
    CHECK(tree && strstr(tree, "'t' ( in 2-element array of 3X3 matrix of float)"));
    CHECK(tree && strstr(tree, "0:4  Function Definition"));
    hn_free(tree);
    CHECK_FAILS(!hn_glsl_tree(HN_FRAGMENT, HEAD "float f() { return a; }\n"), "ERROR: 0:2: 'a'");
    CHECK_FAILS(!hn_glsl_tree(HN_FRAGMENT, HEAD "#error e\n"), "#error");
    CHECK_FAILS(!hn_glsl_tree(HN_FRAGMENT, NULL), "hn_glsl_tree: no text");
}

/* How many instructions of an opcode there are whose operand `place` (0: the first) is `value`. */
static int instructions(const uint32_t *words, size_t n, uint32_t opcode, uint32_t place, uint32_t value) {
    int found = 0;
    for (size_t k = 5; k < n && words[k] >> 16 > 0; k += words[k] >> 16)
        found += (words[k] & 0xffff) == opcode && place + 1 < words[k] >> 16 && words[k + 1 + place] == value;
    return found;
}

/* 1 when an OpName gives this name. */
static int is_named(const uint32_t *words, size_t n, const char *name) {
    enum { OP_NAME = 5 };
    for (size_t k = 5; k < n && words[k] >> 16 > 0; k += words[k] >> 16)
        if ((words[k] & 0xffff) == OP_NAME && strcmp((const char *)&words[k + 2], name) == 0)
            return 1;
    return 0;
}

static void test_spirv(void) {
    enum { MAGIC = 0x07230203, OP_LINE = 8, OP_FUNCTION = 54, NO_CONTROL = 0 };
    const char *text = HEAD "uniform Block { float b; };\n"
                            "uniform float u;\n"
                            "float called(float x) {\n"
                            "    float kept = x * u + b;\n"
                            "    return kept * 0.0; }\n"
                            "float f(); float uncalled() { return f(); }\n" /* must not crash the generator */
                            "void main() { called(1.0); }\n";
    uint32_t *words = NULL;
    size_t n = 0;
    CHECK(hn_glsl_spirv(HN_FRAGMENT, text, &words, &n) == 0);
    CHECK(n > 5 && words[0] == MAGIC);
    CHECK(instructions(words, n, OP_FUNCTION, 2, NO_CONTROL) == 2);
    CHECK(is_named(words, n, "called(f1;"));
    CHECK(is_named(words, n, "kept")); /* an optimiser would have removed it */
    CHECK(is_named(words, n, "u"));
    CHECK(instructions(words, n, OP_LINE, 1, 5) > 0);
    CHECK(instructions(words, n, OP_LINE, 1, 6) > 0);
    CHECK(instructions(words, n, OP_LINE, 1, 9) == 0);
    hn_free(words);

    CHECK_FAILS(hn_glsl_spirv(HN_FRAGMENT, HEAD "float f() { return a; }\n", &words, &n) == -1,
                "ERROR: 0:2: 'a'");
    CHECK_FAILS(hn_glsl_spirv(HN_FRAGMENT, HEAD "float f;\n", &words, &n) == -1, "Missing entry point");
    CHECK_FAILS(hn_glsl_spirv(HN_FRAGMENT, HEAD "float f(); void main() { f(); }\n", &words, &n) == -1,
                "No function definition (body) found");
    CHECK_FAILS(hn_glsl_spirv(HN_FRAGMENT, NULL, &words, &n) == -1, "hn_glsl_spirv: no text");
}

static void test_spirv_vulkan(void) {
    enum { MAGIC = 0x07230203, VERSION_1_0 = 0x00010000 };
    size_t n_words = 7;
    uint32_t *words = NULL;
    CHECK(hn_glsl_spirv_vulkan(HN_FRAGMENT,
                               "#version 450\n"
                               "uniform float plain;\n"
                               "layout(location = 0) out vec4 color;\n"
                               "void main() { color = vec4(plain); }\n",
                               &words, &n_words) == 0);
    CHECK(words && n_words > 5 && words[0] == MAGIC && words[1] == VERSION_1_0);
    hn_free(words);
    CHECK(hn_glsl_spirv_vulkan(HN_VERTEX,
                               "#version 450\nvoid main() { gl_Position = vec4(gl_VertexIndex); }\n", &words,
                               &n_words) == 0);
    CHECK(words && n_words > 5);
    hn_free(words);
    CHECK_FAILS(hn_glsl_spirv_vulkan(HN_VERTEX, "#version 450\nvoid main() { gl_Position = vec4(a); }\n",
                                     &words, &n_words) == -1,
                "ERROR: 0:2: 'a'");
    CHECK(n_words == 0);
    CHECK_FAILS(hn_glsl_spirv_vulkan(HN_FRAGMENT, NULL, &words, &n_words) == -1,
                "hn_glsl_spirv_vulkan: no text");
}

void test_glsl(void) {
    test_version();
    CHECK(strcmp(hn_error(), "") == 0);
    test_check();
    test_long_message();
    test_preprocess();
    test_tree();
    test_spirv();
    test_spirv_vulkan();
}
