// ladder.glsl: the rungs of each term, of which a pass chooses one by a macro. What each is, where it comes from and where
// it holds is said where it is computed, and in ladder.toml.
#ifndef LADDER_GLSL
#define LADDER_GLSL

// BRDF_D, how the distribution finds the angle between n and h.
#define D_EXERCISE 0  // from n.h: as written, loses all digits below roughness 0.1
#define D_CROSS 1     // from |n x H|: exact to the rounding of the vectors at every roughness
#define D_ONE_MINUS 2 // from (1 - n.h)(1 + n.h): the algebra is sound, n.h is as coarse as in the exercise's
#define D_PROJECT 3   // from |H - n (n.H)|: cheaper than the cross product, trusts |n| = 1
#define D_HALF 4      // from |n x h|, up to 65504: for half precision
#ifndef BRDF_D
#define BRDF_D D_CROSS
#endif

// BRDF_V, the visibility G / (4 NoL NoV).
#define V_EXACT 0     // height-correlated Smith
#define V_HAMMON 1    // Hammon 2017: no square roots, up to 28 % off
#define V_SCHLICK 2   // separable, k = alpha/2
#define V_KARIS 3     // separable, k = (roughness + 1)^2/8
#define V_SEPARABLE 4 // Smith's masking and shadowing, each by itself
#define V_KELEMEN 5   // 1/(4 LoH^2)
#ifndef BRDF_V
#define BRDF_V V_EXACT
#endif

// BRDF_F, the Fresnel term.
#define F_POW 0        // Schlick's, by pow(x, 5)
#define F_MULTIPLY 1   // Schlick's, by x^2 x^2 x: more accurate and cheaper
#define F_GAUSSIAN 2   // Schlick's, by exp2
#define F_DIELECTRIC 3 // exact for the refractive index 1.5 of dielectrics; metals by Schlick's
#define F_F82 4        // Schlick's, and for metals a tint at 82 degrees
#ifndef BRDF_F
#define BRDF_F F_MULTIPLY
#endif

// BRDF_DIFFUSE, how light scatters below the surface, and what the highlight leaves for it.
#define DIFFUSE_FRESNEL 0 // Lambert, 1 - F(h.l)
#define DIFFUSE_LAMBERT 1 // Lambert, all of it
#define DIFFUSE_F0 2      // Lambert, 1 - F0
#define DIFFUSE_SHIRLEY 3 // what a smooth surface leaves, toward both directions
#define DIFFUSE_BURLEY 4  // Disney's
#define DIFFUSE_EON 5     // energy-preserving Oren-Nayar
#define DIFFUSE_ENERGY 6  // Lambert, all that the highlight does not reflect toward the viewer: 1 - E(n.v)
#ifndef BRDF_DIFFUSE
#define BRDF_DIFFUSE DIFFUSE_FRESNEL
#endif

// BRDF_MULTI, light that is reflected more than once between microfacets.
#define MULTI_NONE 0   // lost
#define MULTI_FITTED 1 // returned in the shape of the highlight
#ifndef BRDF_MULTI
#define BRDF_MULTI MULTI_NONE
#endif

// F82_TINT, for F_F82: what a metal reflects at 82 degrees, as a share of what Schlick's term says, 0...1. Aluminium's is
// 0.9; that of chromium, iron and titanium 0.75, of gold and copper 0.98. 1 makes it Schlick's term.
#ifndef F82_TINT
#define F82_TINT vec3(0.9)
#endif

#endif
