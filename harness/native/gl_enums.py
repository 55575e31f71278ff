"""The few OpenGL enumerations that pass through the native interface, by their GL names (values: Khronos' gl.xml)."""

GL_NONE = 0
GL_FRONT = 0x0404
GL_BACK = 0x0405
GL_CW = 0x0900
GL_CCW = 0x0901

GL_NEAREST = 0x2600
GL_LINEAR = 0x2601
GL_NEAREST_MIPMAP_NEAREST = 0x2700
GL_LINEAR_MIPMAP_NEAREST = 0x2701
GL_NEAREST_MIPMAP_LINEAR = 0x2702
GL_LINEAR_MIPMAP_LINEAR = 0x2703
GL_REPEAT = 0x2901
GL_CLAMP_TO_EDGE = 0x812F
GL_MIRRORED_REPEAT = 0x8370

GL_INT = 0x1404
GL_UNSIGNED_INT = 0x1405
GL_FLOAT = 0x1406
GL_FLOAT_VEC2 = 0x8B50
GL_FLOAT_VEC3 = 0x8B51
GL_FLOAT_VEC4 = 0x8B52
GL_INT_VEC2 = 0x8B53
GL_INT_VEC3 = 0x8B54
GL_INT_VEC4 = 0x8B55
GL_BOOL = 0x8B56
GL_BOOL_VEC2 = 0x8B57
GL_BOOL_VEC3 = 0x8B58
GL_BOOL_VEC4 = 0x8B59
GL_FLOAT_MAT2 = 0x8B5A
GL_FLOAT_MAT3 = 0x8B5B
GL_FLOAT_MAT4 = 0x8B5C
GL_SAMPLER_2D = 0x8B5E

#: GL type -> how many numbers a value of it has; 1 for those not here
COMPONENTS = {
    GL_FLOAT_VEC2: 2,
    GL_FLOAT_VEC3: 3,
    GL_FLOAT_VEC4: 4,
    GL_INT_VEC2: 2,
    GL_INT_VEC3: 3,
    GL_INT_VEC4: 4,
    GL_BOOL_VEC2: 2,
    GL_BOOL_VEC3: 3,
    GL_BOOL_VEC4: 4,
    GL_FLOAT_MAT2: 4,
    GL_FLOAT_MAT3: 9,
    GL_FLOAT_MAT4: 16,
}

#: GL type of a uniform or attribute -> its name in GLSL, for messages.
GLSL_TYPE_NAMES = {
    GL_INT: "int",
    GL_UNSIGNED_INT: "uint",
    GL_FLOAT: "float",
    GL_FLOAT_VEC2: "vec2",
    GL_FLOAT_VEC3: "vec3",
    GL_FLOAT_VEC4: "vec4",
    GL_INT_VEC2: "ivec2",
    GL_INT_VEC3: "ivec3",
    GL_INT_VEC4: "ivec4",
    GL_BOOL: "bool",
    GL_BOOL_VEC2: "bvec2",
    GL_BOOL_VEC3: "bvec3",
    GL_BOOL_VEC4: "bvec4",
    GL_FLOAT_MAT2: "mat2",
    GL_FLOAT_MAT3: "mat3",
    GL_FLOAT_MAT4: "mat4",
    GL_SAMPLER_2D: "sampler2D",
}
