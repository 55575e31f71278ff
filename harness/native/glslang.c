/* glslang.c: checks, preprocesses and parses GLSL with glslang, through its C interface; needs no context. */
#include "internal.h"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <glslang/build_info.h>

#include <stdlib.h>
#include <string.h>

/* For a text without #version. */
enum { DEFAULT_VERSION = 330 };

/* Whose rules a text is held to. The difference is more than the rules: with SPIR-V as the target glslang
 * defines GL_SPIRV, which no driver does, so a text on its way to the driver must not be preprocessed for
 * SPIR-V. Vulkan's rules are relaxed here: a uniform needs no block. */
typedef enum { FOR_DRIVER, FOR_SPIRV, FOR_VULKAN } target;

static glslang_client_t client(target rules) {
    switch (rules) {
    case FOR_SPIRV:
        return GLSLANG_CLIENT_OPENGL;
    case FOR_VULKAN:
        return GLSLANG_CLIENT_VULKAN;
    default:
        return GLSLANG_CLIENT_NONE;
    }
}

/* A failure with glslang's log, without the blank lines around it. */
static int fail_with_log(const char *operation, const char *log) {
    log = log ? log + strspn(log, " \n") : "";
    size_t length = strlen(log);
    while (length > 0 && strchr(" \n", log[length - 1]))
        --length;
    /* By itself, so that each line begins as glslang's lines do. */
    if (length > 0)
        return hn_fail("%.*s", (int)length, log);
    return hn_fail("%s: glslang failed and gave no reason", operation);
}

static int describe(const char *operation, hn_stage stage, const char *text, target rules,
                    glslang_input_t *input) {
    static int initialized;
    if (!initialized && !glslang_initialize_process())
        return hn_fail("%s: glslang does not start", operation);
    initialized = 1;
    if (!text)
        return hn_fail("%s: no text", operation);
    if (stage < HN_VERTEX || stage >= HN_STAGES)
        return hn_fail("%s: no stage %d", operation, (int)stage);
    static const glslang_stage_t stages[] = {
        [HN_VERTEX] = GLSLANG_STAGE_VERTEX,
        [HN_FRAGMENT] = GLSLANG_STAGE_FRAGMENT,
        [HN_GEOMETRY] = GLSLANG_STAGE_GEOMETRY,
        [HN_TESS_CONTROL] = GLSLANG_STAGE_TESSCONTROL,
        [HN_TESS_EVALUATION] = GLSLANG_STAGE_TESSEVALUATION,
        [HN_COMPUTE] = GLSLANG_STAGE_COMPUTE,
    };

    *input = (glslang_input_t){
        .language = GLSLANG_SOURCE_GLSL,
        .stage = stages[stage],
        .client = client(rules),
        .client_version = rules == FOR_VULKAN ? GLSLANG_TARGET_VULKAN_1_0 : GLSLANG_TARGET_OPENGL_450,
        .target_language = rules == FOR_DRIVER ? GLSLANG_TARGET_NONE : GLSLANG_TARGET_SPV,
        .target_language_version = GLSLANG_TARGET_SPV_1_0,
        .code = text,
        .default_version = DEFAULT_VERSION,
        .default_profile = GLSLANG_NO_PROFILE,
        /* Without cascading, glslang stops at the first error. */
        .messages = GLSLANG_MSG_CASCADING_ERRORS_BIT | (rules == FOR_DRIVER ? 0 : GLSLANG_MSG_SPV_RULES_BIT) |
                    (rules == FOR_VULKAN ? GLSLANG_MSG_VULKAN_RULES_BIT : 0),
        .resource = glslang_default_resource(),
    };
    return 0;
}

/* A shader after the preprocessor, or NULL. `options` are of glslang_shader_options_t. */
static glslang_shader_t *preprocess_with(const char *operation, const glslang_input_t *input, int options) {
    glslang_shader_t *shader = glslang_shader_create(input);
    if (!shader) {
        hn_fail("%s: glslang makes no shader", operation);
        return NULL;
    }
    glslang_shader_set_options(shader, options);
    if (!glslang_shader_preprocess(shader, input)) {
        fail_with_log(operation, glslang_shader_get_info_log(shader));
        glslang_shader_delete(shader);
        return NULL;
    }
    return shader;
}

/* Locations are given out as SHADERed has it done. Bindings are not: it refuses a uniform block without one. */
static glslang_shader_t *preprocess(const char *operation, const glslang_input_t *input) {
    return preprocess_with(operation, input, GLSLANG_SHADER_AUTO_MAP_LOCATIONS);
}

/* A shader after the parser, or NULL. (The C interface parses what its preprocessor left.) */
static glslang_shader_t *parse_with(const char *operation, const glslang_input_t *input, int options) {
    glslang_shader_t *shader = preprocess_with(operation, input, options);
    if (shader && !glslang_shader_parse(shader, input)) {
        fail_with_log(operation, glslang_shader_get_info_log(shader));
        glslang_shader_delete(shader);
        return NULL;
    }
    return shader;
}

static glslang_shader_t *parse(const char *operation, const glslang_input_t *input) {
    return parse_with(operation, input, GLSLANG_SHADER_AUTO_MAP_LOCATIONS);
}

/* The linked program of one parsed shader, with its SPIR-V, or NULL. */
static glslang_program_t *generate_spirv(const char *operation, glslang_shader_t *shader,
                                         const glslang_input_t *input, glslang_spv_options_t options) {
    glslang_program_t *program = glslang_program_create();
    if (!program) {
        hn_fail("%s: glslang makes no program", operation);
        return NULL;
    }
    glslang_program_add_shader(program, shader);
    const char *log = NULL;
    if (!glslang_program_link(program, (int)input->messages) || !glslang_program_map_io(program)) {
        log = glslang_program_get_info_log(program);
    } else {
        glslang_program_SPIRV_generate_with_options(program, input->stage, &options);
        if (glslang_program_SPIRV_get_size(program) > 0)
            return program;
        log = glslang_program_SPIRV_get_messages(program);
    }
    fail_with_log(operation, log);
    glslang_program_delete(program);
    return NULL;
}

int hn_glsl_check(hn_stage stage, const char *text, int spirv) {
    const char *operation = "hn_glsl_check";
    glslang_input_t input;
    if (describe(operation, stage, text, spirv ? FOR_SPIRV : FOR_DRIVER, &input))
        return -1;
    glslang_shader_t *shader = parse(operation, &input);
    if (!shader)
        return -1;
    int result = 0;
    if (spirv) {
        glslang_spv_options_t options = {.disable_optimizer = true};
        glslang_program_t *program = generate_spirv(operation, shader, &input, options);
        result = program ? 0 : -1;
        if (program)
            glslang_program_delete(program);
    }
    glslang_shader_delete(shader);
    return result;
}

/* A stage as SPIR-V. `shader_options` are of glslang_shader_options_t, `messages` are added to the input's. */
static int to_spirv(const char *operation, hn_stage stage, const char *text, target rules, int messages,
                    int shader_options, glslang_spv_options_t options, uint32_t **words, size_t *n_words) {
    *n_words = 0;
    glslang_input_t input;
    if (describe(operation, stage, text, rules, &input))
        return -1;
    input.messages = (glslang_messages_t)((int)input.messages | messages);
    glslang_shader_t *shader =
        parse_with(operation, &input,
                   GLSLANG_SHADER_AUTO_MAP_LOCATIONS | GLSLANG_SHADER_AUTO_MAP_BINDINGS | shader_options);
    if (!shader)
        return -1;
    glslang_program_t *program = generate_spirv(operation, shader, &input, options);
    int result = -1;
    if (program) {
        size_t size = glslang_program_SPIRV_get_size(program);
        *words = malloc(size * sizeof **words);
        if (*words) {
            glslang_program_SPIRV_get(program, *words);
            *n_words = size;
            result = 0;
        } else {
            hn_fail("%s: out of memory", operation);
        }
        glslang_program_delete(program);
    }
    glslang_shader_delete(shader);
    return result;
}

int hn_glsl_spirv(hn_stage stage, const char *text, uint32_t **words, size_t *n_words) {
    /* The debug bit has the parser keep the lines, which the generator then writes down. Uncalled functions are
     * not kept: where one calls a function without a body, the generator crashes. */
    glslang_spv_options_t options = {.generate_debug_info = true, .disable_optimizer = true};
    return to_spirv("hn_glsl_spirv", stage, text, FOR_SPIRV, GLSLANG_MSG_DEBUG_INFO_BIT, 0, options, words,
                    n_words);
}

int hn_glsl_spirv_vulkan(hn_stage stage, const char *text, uint32_t **words, size_t *n_words) {
    glslang_spv_options_t options = {.disable_optimizer = true};
    return to_spirv("hn_glsl_spirv_vulkan", stage, text, FOR_VULKAN, 0, GLSLANG_SHADER_VULKAN_RULES_RELAXED,
                    options, words, n_words);
}

static char *copy(const char *operation, const char *text) {
    size_t size = strlen(text) + 1;
    char *result = malloc(size);
    if (!result) {
        hn_fail("%s: out of memory", operation);
        return NULL;
    }
    return memcpy(result, text, size);
}

char *hn_glsl_preprocess(hn_stage stage, const char *text) {
    const char *operation = "hn_glsl_preprocess";
    glslang_input_t input;
    if (describe(operation, stage, text, FOR_DRIVER, &input))
        return NULL;
    glslang_shader_t *shader = preprocess(operation, &input);
    if (!shader)
        return NULL;
    /* glslang puts every token on its line of the input (and a macro's expansion where the call ends), so
     * there is nothing to repair; the tests hold it to that. */
    char *result = copy(operation, glslang_shader_get_preprocessed_code(shader));
    glslang_shader_delete(shader);
    return result;
}

char *hn_glsl_tree(hn_stage stage, const char *text) {
    const char *operation = "hn_glsl_tree";
    glslang_input_t input;
    if (describe(operation, stage, text, FOR_DRIVER, &input))
        return NULL;
    input.messages |= GLSLANG_MSG_AST_BIT | GLSLANG_MSG_KEEP_UNCALLED_BIT;
    glslang_shader_t *shader = parse(operation, &input);
    if (!shader)
        return NULL;
    /* The parser writes the tree, before any linking could miss main() or drop a function. */
    char *result = copy(operation, glslang_shader_get_info_debug_log(shader));
    glslang_shader_delete(shader);
    return result;
}

#define TEXT_OF(value) #value
#define TEXT(value) TEXT_OF(value)

const char *hn_glsl_version(void) {
    return TEXT(GLSLANG_VERSION_MAJOR) "." TEXT(GLSLANG_VERSION_MINOR) "." TEXT(GLSLANG_VERSION_PATCH);
}
