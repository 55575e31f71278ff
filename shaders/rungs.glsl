// rungs.glsl: the terms of the model as the literature has them, and each term by the rung that its macro chooses. Pure
// functions; brdf.glsl, whose names it uses, includes it after the exercise's own terms. Cosines are 0...1.
#ifndef RUNGS_GLSL
#define RUNGS_GLSL

#include "energy.glsl"

// ---- Distribution ----------------------------------------------------------------------------------------------------

// k of D = k^2/pi, by the rungs that need h itself; alpha 0...1, NoHH = n.H for H = l + v, 0 or more. At most 5e12.
// From n.h the angle is lost where it is small: 1 - (n.h)^2 is then less than the rounding of n.h.
float distribution_root(vec3 n, vec3 H, float NoHH, float alpha)
{
    float per_length = inversesqrt(dot(H, H) + 1e-37);
    float NoH = min(NoHH * per_length, 1.0);
    float alpha2 = alpha * alpha + 1e-26; // as in shade()
#if BRDF_D == D_ONE_MINUS
    // 1 - (n.h)^2 as a product, which loses nothing more [Guy & Agopian 2018, "Physically Based Rendering in Filament",
    // 4.4.1, on desktop].
    return alpha / ((1.0 - NoH) * (1.0 + NoH) + alpha2 * (NoH * NoH));
#else
    return alpha / max(1.0 + NoH * NoH * (alpha2 - 1.0), alpha2);
#endif
}

// The divisor of k for half precision, of 16 H: sin2 is that of step 2 in shade(), a is alpha n.H. alpha^2 does not stand by
// itself: below roughness 0.089 it has no digits. max(), since a sum would take 4 % off k at 0.089 and n.H 0.3.
float half_divisor(float sin2, float a)
{
    return max(a * a + sin2, HALF_LEAST);
}

// D: Trowbridge-Reitz/GGX distribution of normals around n at h = (l + v)/|l + v|, by the rung BRDF_D; per steradian.
float distribution(vec3 l, vec3 v, vec3 n, float alpha)
{
    vec3 H = l + v;
    float NoHH = max(dot(n, l) + dot(n, v), 0.0);
#if BRDF_D == D_HALF
    vec3 across = 8.0 * (H - n * NoHH);
    float cosine = 8.0 * NoHH;
    float sin2 = dot(across, across);
    float k = alpha * (sin2 + cosine * cosine) / half_divisor(sin2, alpha * cosine);
    return min(k / PI * k, HALF_MOST);
#else
#if BRDF_D == D_CROSS || BRDF_D == D_PROJECT
#if BRDF_D == D_PROJECT
    vec3 across = H - n * NoHH;
#else
    vec3 across = cross(n, H);
#endif
    float sin2 = dot(across, across) + 1e-37;
    float cos2 = NoHH * NoHH;
    float k = alpha * (sin2 + cos2) / (sin2 + (alpha * alpha + 1e-26) * cos2);
#else
    float k = distribution_root(n, H, NoHH, alpha);
#endif
    return k * k / PI;
#endif
}

// ---- Visibility ------------------------------------------------------------------------------------------------------

// 1/(4 x) for x of 0 or more; a number also at 0.
float over_four(float x)
{
#if BRDF_D == D_HALF
    return 1.0 / (4.0 * x + HALF_LEAST);
#else
    return 0.25 / (x + 1e-37); // which only 0/0 would reach
#endif
}

// Hammon's V [Hammon 2017, "PBR Diffuse Lighting for GGX+Smith Microsurfaces", GDC, p. 84]: the square roots of
// V_SmithGGXCorrelated replaced by linear interpolation in alpha; exact at alpha 0 and 1.
float V_Hammon(float NoL, float NoV, float alpha)
{
    return over_four(mix(NoL * NoV, 0.5 * (NoL + NoV), alpha)); // a GPU halves for nothing
}

// Schlick's rational function in place of each of Smith's two factors, x/(x (1 - k) + k) [Schlick 1994, eq. 19].
float V_Schlick(float NoL, float NoV, float k)
{
    return over_four((NoL * (1.0 - k) + k) * (NoV * (1.0 - k) + k));
}

// Smith's masking and shadowing as if they were independent, G1(l) G1(v)/(4 NoL NoV) [Walter et al. 2007, eqs. 23, 34].
float V_SmithGGX(float NoL, float NoV, float alpha)
{
    float alpha2 = alpha * alpha + 1e-26; // as in shade(), whose k does not outgrow it then
    float masking = NoV + sqrt((NoV - alpha2 * NoV) * NoV + alpha2);
    float shadowing = NoL + sqrt((NoL - alpha2 * NoL) * NoL + alpha2);
#if BRDF_D == D_HALF
    return 1.0 / (masking * shadowing + HALF_LEAST);
#else
    return 1.0 / (masking * shadowing);
#endif
}

// Of Cook and Torrance's V-shaped grooves, 1/(4 LoH^2), whatever the roughness [Kelemen & Szirmay-Kalos 2001, eq. 9].
float V_Kelemen(float LoH)
{
    return over_four(LoH * LoH);
}

// V = G/(4 NoL NoV), by the rung BRDF_V.
float visibility(float NoL, float NoV, float LoH, float alpha)
{
#if BRDF_V == V_HAMMON
    return V_Hammon(NoL, NoV, alpha);
#elif BRDF_V == V_SCHLICK
    return V_Schlick(NoL, NoV, 0.5 * alpha); // so that it is near Smith's [Karis 2013, "Real Shading in Unreal Engine 4"]
#elif BRDF_V == V_KARIS
    float up = sqrt(alpha) + 1.0; // roughness + 1: made less extreme for lights [Burley 2012; Karis 2013, eq. 4]
    return V_Schlick(NoL, NoV, 0.125 * (up * up));
#elif BRDF_V == V_SEPARABLE
    return V_SmithGGX(NoL, NoV, alpha);
#elif BRDF_V == V_KELEMEN
    return V_Kelemen(LoH);
#else
    return V_SmithGGXCorrelated(NoL, NoV, alpha);
#endif
}

// ---- Fresnel ---------------------------------------------------------------------------------------------------------

// 1 - (1 - c)^5 for c in 0...1, as a sum of positive terms (see shade(), step 4).
float fifth_rest(float c)
{
    float x = clamp(1.0 - c, 0.0, 1.0);
    float x2 = x * x;
    float x4 = x2 * x2;
    float left2 = c * x + c;          // 1 - x^2
    float left4 = left2 * x2 + left2; // 1 - x^4
    return x4 * c + left4;            // 1 - x^5
}

// What a dielectric of refractive index 1.5 reflects (x) and lets in (y), averaged over polarisations [Fresnel 1823; Cook &
// Torrance 1982, p. 17]. LoH in 0...1. y is 1 - x, as a product: nothing cancels as LoH goes to 0.
vec2 fresnel_dielectric(float LoH)
{
    const float n2 = 2.25;
    float g = sqrt(LoH * LoH + (n2 - 1.0));
    float s = 1.0 / (g + LoH);
    float p = 1.0 / (g + n2 * LoH);
    float rs = (g - LoH) * s;
    float rp = (g - n2 * LoH) * p;
    return vec2(0.5 * (rs * rs + rp * rp), 2.0 * g * LoH * (s * s + n2 * (p * p)));
}

// What Schlick's term loses for a metal of F0 to have the tint F82_TINT at LoH = 1/7, which is 82 degrees [Kutz, Hasan &
// Edmondson 2021, "Novel aspects of the Adobe Standard Material"; Hoffman 2019]. LoH in 0...1.
vec3 f82_drop(vec3 F0, float LoH)
{
    const float F7 = 7776.0 / 16807.0;     // (1 - 1/7)^5
    const float PEAK = 46656.0 / 823543.0; // of LoH (1 - LoH)^6, which is at 1/7
    float x = 1.0 - LoH;
    float x2 = x * x;
    return (1.0 - F82_TINT) * (F0 + (1.0 - F0) * F7) * (LoH * (x2 * x2 * x2) / PEAK);
}

// F of a dielectric, by the rung BRDF_F.
float F_dielectric(float LoH)
{
#if BRDF_F == F_DIELECTRIC
    return fresnel_dielectric(LoH).x;
#else
    return DIELECTRIC_F0 + (1.0 - DIELECTRIC_F0) * schlick_weight(LoH);
#endif
}

// F of a metal whose reflectance at normal incidence is F0, by the rung BRDF_F.
vec3 F_metal(vec3 F0, float LoH)
{
#if BRDF_F == F_F82
    return max(F_Schlick(F0, LoH) - f82_drop(F0, LoH), 0.0);
#else
    return F_Schlick(F0, LoH);
#endif
}

// F, by the rung BRDF_F. LoH in 0...1. Where dielectrics and metals differ, F0 up to that of the dielectric is one.
vec3 fresnel(vec3 F0, float LoH)
{
#if BRDF_F == F_DIELECTRIC || BRDF_F == F_F82
    return mix(F_metal(F0, LoH), vec3(F_dielectric(LoH)), lessThanEqual(F0, vec3(DIELECTRIC_F0)));
#else
    return F_Schlick(F0, LoH);
#endif
}

// F of a material: of the dielectric and the metal that it is mixed of.
vec3 F_material(Material m, float LoH)
{
    return mix(vec3(F_dielectric(LoH)), F_metal(m.albedo, LoH), m.metalness);
}

// ---- Multiple scattering ---------------------------------------------------------------------------------------------

// What the highlight is multiplied by for the light that leaves after several reflections, by the rung BRDF_MULTI: as much
// as is lost, in the same shape [Turquin 2019, "Practical multiple scattering compensation for microfacet models", eq. 16].
vec3 compensation(vec3 F0, float NoV, float roughness)
{
#if BRDF_MULTI == MULTI_FITTED
    return 1.0 + F0 * energy_lost(NoV, roughness);
#else
    return vec3(1.0);
#endif
}

// ---- Diffuse ---------------------------------------------------------------------------------------------------------

// Each is pi times a BRDF, as a share of the albedo.

// 21/20 (1 - F0) (1 - (1 - NoL)^5) (1 - (1 - NoV)^5): reciprocal, and with what a mirror reflects all that there is
// [Shirley, Smits, Hu & Lafortune 1997, "A practitioners' assessment of light reflection models"].
float diffuse_shirley(float NoL, float NoV)
{
    return 1.05 * (1.0 - DIELECTRIC_F0) * fifth_rest(NoL) * fifth_rest(NoV);
}

// Brighter toward grazing angles where rough, darker where smooth [Burley 2012, "Physically-based shading at Disney", 5.3].
float diffuse_burley(float NoL, float NoV, float LoH, float roughness)
{
    float at_grazing = 2.0 * roughness * LoH * LoH - 0.5; // F_D90 - 1
    return (at_grazing * (1.0 - fifth_rest(NoL)) + 1.0) * (at_grazing * (1.0 - fifth_rest(NoV)) + 1.0);
}

// What the highlight leaves of light toward v: 1 - E(NoV) of a dielectric, with what is scattered several times
// [Kelemen & Szirmay-Kalos 2001, whose second factor makes it reciprocal; here without].
float diffuse_energy(float NoV, float roughness)
{
    float lost = energy_lost(NoV, roughness);
    float reflected = F_dielectric(energy_cosine(NoV, roughness)) / (1.0 + lost);
    return 1.0 - reflected * compensation(vec3(DIELECTRIC_F0), NoV, roughness).x;
}

// How far the albedo of EON's single scattering is from the least, at a cosine: G/pi of its eq. 14, by its polynomial.
float eon_g(float cosine)
{
    float x = 1.0 - cosine;
    return (((0.0714429953 * x - 0.332181442) * x + 0.491881867) * x + 0.0571085289) * x;
}

// pi times the energy-preserving Oren-Nayar BRDF [Portsmouth, Kutz & Hill 2025, "EON: A practical energy-preserving rough
// diffuse BRDF", JCGT 14(1)]: Fujii's Oren-Nayar, and what it loses between facets. LoV = l.v. Its ratio of albedos,
// (1 - E(l)) (1 - E(v))/(1 - <E>), is written out here, since that is 0/0 at roughness 0.
vec3 diffuse_eon(vec3 albedo, float roughness, float NoL, float NoV, float LoV)
{
    const float C1 = 0.5 - 2.0 / (3.0 * PI);
    const float C2 = 2.0 / 3.0 - 28.0 / (15.0 * PI);
    float A = 1.0 / (1.0 + C1 * roughness);
    float s = LoV - NoL * NoV;
    float t = s > 0.0 ? max(max(NoL, NoV), TINY) : 1.0;
    float single = max(1.0 + roughness * (s / t), 0.0);
    float average = A * (1.0 + C2 * roughness); // <E>
    float lost = max(C1 - eon_g(NoL), 0.0) * max(C1 - eon_g(NoV), 0.0) * roughness / (C1 - C2);
    return albedo * (A * (single + lost * (albedo * average / (1.0 - albedo * (1.0 - average)))));
}

// What the rungs that keep Lambert's shape scatter, as a share of the albedo over pi.
float lambert_share(float NoL, float NoV, float LoH, float roughness)
{
#if BRDF_DIFFUSE == DIFFUSE_F0
    return 1.0 - DIELECTRIC_F0; // [Schlick 1994] at normal incidence, as in Unity's standard shader
#elif BRDF_DIFFUSE == DIFFUSE_SHIRLEY
    return diffuse_shirley(NoL, NoV);
#elif BRDF_DIFFUSE == DIFFUSE_BURLEY
    return diffuse_burley(NoL, NoV, LoH, roughness);
#elif BRDF_DIFFUSE == DIFFUSE_ENERGY
    return diffuse_energy(NoV, roughness);
#else
    return 1.0;
#endif
}

// The diffuse BRDF of a material, per steradian, by the rung BRDF_DIFFUSE: of the part of it that is a dielectric.
vec3 diffuse(vec3 l, vec3 v, vec3 n, Material m)
{
    float NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, v), 0.0, 1.0);
    float LoH = 0.5 * length(l + v);
#if BRDF_DIFFUSE == DIFFUSE_FRESNEL
    vec3 scattered = m.albedo * (1.0 - F_material(m, LoH));
#elif BRDF_DIFFUSE == DIFFUSE_EON
    vec3 scattered = diffuse_eon(m.albedo, m.roughness, NoL, NoV, dot(l, v));
#else
    vec3 scattered = m.albedo * lambert_share(NoL, NoV, LoH, m.roughness);
#endif
    return (1.0 - m.metalness) / PI * scattered;
}

#endif
