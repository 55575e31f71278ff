// brdf.glsl: how a surface reflects light: Lambert under a GGX microfacet layer. Pure functions, no uniforms.
//
// Notation of the field: l points to the light, v to the viewer, n is the normal, h = (l + v)/|l + v| the half vector,
// all unit; NoL is n.l clamped to 0...1, and so on; alpha = roughness^2. Colours are linear.
//
// Each term with a real trade has rungs, chosen by a macro of the pass: the first of each pair is the exercise's own.
#ifndef BRDF_GLSL
#define BRDF_GLSL

// BRDF_D, how the distribution finds the angle between n and h.
#define D_EXERCISE 0 // from n.h: as written, loses all digits below roughness 0.1
#define D_CROSS 1    // from |n x H|: exact to the rounding of the vectors at every roughness
#ifndef BRDF_D
#define BRDF_D D_CROSS
#endif

// BRDF_V, the visibility G / (4 NoL NoV).
#define V_EXACT 0  // height-correlated Smith
#define V_HAMMON 1 // Hammon 2017: no square roots, up to 28 % off
#ifndef BRDF_V
#define BRDF_V V_EXACT
#endif

// BRDF_F, how Schlick's fifth power is computed.
#define F_POW 0      // pow(x, 5)
#define F_MULTIPLY 1 // x^2 x^2 x: more accurate and cheaper
#ifndef BRDF_F
#define BRDF_F F_MULTIPLY
#endif

// BRDF_DIFFUSE, the share of the light that is left for diffuse scattering.
#define DIFFUSE_FRESNEL 0 // 1 - F(h.l)
#define DIFFUSE_LAMBERT 1 // all of it
#ifndef BRDF_DIFFUSE
#define BRDF_DIFFUSE DIFFUSE_FRESNEL
#endif

const float PI = 3.14159265358979;
const float DIELECTRIC_F0 = 0.04; // reflectance at normal incidence of a refractive index of 1.5
const float TINY = 1.2e-38;       // just above the smallest normal float: a divisor that is never reached otherwise

struct Material {
    vec3 albedo;     // 0...1: colour scattered by a dielectric, F0 of a metal
    float metalness; // 0...1
    float roughness; // 0...1
};

// ---- The exercise's three terms --------------------------------------------------------------------------------------

// Trowbridge-Reitz/GGX distribution of normals [Walter et al. 2007, eq. 33; Trowbridge & Reitz 1975].
// NoH and alpha in 0...1; per steradian, up to 1/(pi alpha^2).
// In exact arithmetic 1 + NoH^2 (alpha^2 - 1) is never below alpha^2: the max() only mends what rounding does to it.
float D_GGX(float NoH, float alpha)
{
    float alpha2 = alpha * alpha;
    float k = alpha / max(1.0 + NoH * NoH * (alpha2 - 1.0), max(alpha2, TINY));
    return k * k / PI;
}

// Smith's height-correlated masking and shadowing for GGX, G / (4 NoL NoV) [Heitz 2014, eq. 99].
// Finite also where the formula is 1/0 (both cosines 0, or alpha and one of them).
float V_SmithGGXCorrelated(float NoL, float NoV, float alpha)
{
    float alpha2 = alpha * alpha;
    float masking = NoL * sqrt(alpha2 + NoV * (NoV - alpha2 * NoV));
    float shadowing = NoV * sqrt(alpha2 + NoL * (NoL - alpha2 * NoL));
    return 0.5 / max(masking + shadowing, TINY);
}

// (1 - LoH)^5, the weight of white in Schlick's Fresnel term.
float schlick_weight(float LoH)
{
    float x = clamp(1.0 - LoH, 0.0, 1.0);
#if BRDF_F == F_POW
    return pow(x, 5.0);
#else
    float x2 = x * x;
    return x2 * x2 * x;
#endif
}

// Fresnel reflectance, approximated [Schlick 1994, eq. 15]. F0 is the reflectance at normal incidence, 0...1.
vec3 F_Schlick(vec3 F0, float LoH)
{
    return F0 + (1.0 - F0) * schlick_weight(LoH);
}

// Hammon's V [Hammon 2017, "PBR Diffuse Lighting for GGX+Smith Microsurfaces", GDC, p. 84]: the square roots of
// V_SmithGGXCorrelated replaced by linear interpolation in alpha; exact at alpha 0 and 1.
float V_Hammon(float NoL, float NoV, float alpha)
{
    return 0.5 / max(mix(2.0 * NoL * NoV, NoL + NoV, alpha), TINY);
}

// The model as the exercise writes it, term by term. Right in the middle of the range. Below roughness 0.1 the rounding of
// NoH alone is larger than what the highlight is made of, and at l = -v there is no half vector and it is NaN; use shade().
vec3 shade_exercise(vec3 l, vec3 v, vec3 n, Material m)
{
    float alpha = m.roughness * m.roughness;
    vec3 h = normalize(l + v);
    float NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, v), 0.0, 1.0);
    float NoH = clamp(dot(n, h), 0.0, 1.0);
    float LoH = clamp(dot(l, h), 0.0, 1.0);

    vec3 F = F_Schlick(mix(vec3(DIELECTRIC_F0), m.albedo, m.metalness), LoH);
    vec3 specular = F * D_GGX(NoH, alpha) * V_SmithGGXCorrelated(NoL, NoV, alpha);
    vec3 diffuse = (1.0 - F) * (1.0 - m.metalness) * m.albedo / PI;
    return (diffuse + specular) * NoL;
}

// ---- The same model, for every input ---------------------------------------------------------------------------------

// Radiance reflected toward v per unit of irradiance perpendicular to l: (diffuse + specular) (n.l)+.
// Defined, finite and >= 0 for every unit l, v, n and every material in 0...1; 0 on the back side, at both horizons and
// where l = -v. A value beyond 1e37, which the model reaches as roughness goes to 0, is 1e37.
//
// It equals shade_exercise() in exact arithmetic. Term by term, with H = l + v not normalised:
//   cosines  n.H = n.l + n.v, and l.h = |H|/2, because l and v are unit. No division by |H|.
//   sine     |n x H|^2 + (n.H)^2 = |H|^2, because n is unit. For a small angle between n and h the cross product keeps the
//            digits that 1 - (n.h)^2 has lost: the cosine of a small angle is all ones.
//   D        1 + (n.h)^2 (alpha^2 - 1) = |n x h|^2 + alpha^2 (n.h)^2 = (|n x H|^2 + alpha^2 (n.H)^2) / |H|^2, so that
//            D = k^2/pi with k = alpha |H|^2 / (|n x H|^2 + alpha^2 (n.H)^2).
//   1 - F    F = F0 + (1 - F0) w with w = x^5, x = 1 - l.h, so 1 - F = (1 - F0) (1 - x^5), and
//            1 - x^5 = (1 - x) (1 + x + x^2 + x^3 + x^4) = l.h ((1 + x) (1 + x^2) + x^4): nothing cancels as l.h goes to 0.
vec3 shade(vec3 l, vec3 v, vec3 n, Material m)
{
    float alpha = m.roughness * m.roughness;
    float NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, v), 0.0, 1.0);
    vec3 H = l + v;
    float NoHH = NoL + NoV; // n.H where it matters: with both cosines positive
    vec3 nxH = cross(n, H);
    float sin2 = dot(nxH, nxH); // |H|^2 times the squared sine and cosine of the angle between n and h
    float cos2 = NoHH * NoHH;
    float HH = sin2 + cos2;

#if BRDF_D == D_EXERCISE
    float D = D_GGX(NoHH * inversesqrt(max(HH, TINY)), alpha);
#else
    // 1e-37 takes part only where n = h and alpha is 0 (or n.H is): k^2 stays below 1e37, and 0/0 becomes 0, since a mirror
    // does not show a light without extent.
    float k = alpha * HH / (sin2 + (alpha * alpha * cos2 + 1e-37));
    float D = k * k / PI;
#endif
#if BRDF_V == V_HAMMON
    float V = V_Hammon(NoL, NoV, alpha);
#else
    float V = V_SmithGGXCorrelated(NoL, NoV, alpha);
#endif
    float highlight = min(D * (V * NoL), 1e37);

    float LoH = 0.5 * sqrt(HH);
    float w = schlick_weight(LoH);
    vec3 F0 = DIELECTRIC_F0 * (1.0 - m.metalness) + m.albedo * m.metalness;
    vec3 F = F0 + (1.0 - F0) * w;
#if BRDF_DIFFUSE == DIFFUSE_LAMBERT
    vec3 scattered = vec3(1.0);
#else
    float x = 1.0 - LoH;
    float x2 = x * x;
    vec3 scattered = (1.0 - F0) * (LoH * ((1.0 + x) * (1.0 + x2) + x2 * x2)); // 1 - F
#endif
    vec3 radiance = F * highlight + scattered * m.albedo * ((1.0 - m.metalness) * (NoL / PI));
    return NoL > 0.0 && NoV > 0.0 ? radiance : vec3(0.0);
}

#endif
