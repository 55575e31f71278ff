// features.glsl: the macros by which a pass says what it needs. Both stages read them, so that they agree.
#ifndef FEATURES_GLSL
#define FEATURES_GLSL

// 1: read it from a texture. 0: it is a uniform (the normal: it comes from the model).
#ifndef HAS_ALBEDO_MAP
#define HAS_ALBEDO_MAP 0
#endif
#ifndef HAS_ROUGHNESS_MAP
#define HAS_ROUGHNESS_MAP 0
#endif
#ifndef HAS_METALNESS_MAP
#define HAS_METALNESS_MAP 0
#endif
#ifndef HAS_NORMAL_MAP
#define HAS_NORMAL_MAP 0
#endif

// 1: the model has parts whose texture is mirrored; the pass reads their handedness from the Bitangent attribute.
#ifndef HAS_MIRRORED_UV
#define HAS_MIRRORED_UV 0
#endif

// METALNESS, when defined, is 0 or 1: everything in the pass is of that kind, and neither map nor uniform is compiled.

#define MAP_COUNT (HAS_ALBEDO_MAP + HAS_ROUGHNESS_MAP + HAS_METALNESS_MAP + HAS_NORMAL_MAP)

#endif
