// Light on fabric and solid things: a key light from the upper left, the same as on the liquid, a weak fill from the right,
// and the sky. All in eye space: they stay with the camera.

const vec3 kKeyLight = normalize(vec3(-0.45, 0.65, 0.75));
const vec3 kFillLight = normalize(vec3(0.8, 0.1, 0.45));
const vec3 kKeyColor = vec3(1.03, 1.0, 0.95);
const vec3 kSkyColor = vec3(0.95, 0.98, 1.04);

/// @param towardsEye  unit vector; gloss 0 = matt … 1
vec3 lit(vec3 color, vec3 normal, vec3 towardsEye, float gloss)
{
    float key = max((dot(normal, kKeyLight) + 0.15) / 1.15, 0.0);
    float fill = max(dot(normal, kFillLight), 0.0);
    float sky = 0.5 + 0.5 * normal.y;
    float rim = pow(1.0 - clamp(dot(normal, towardsEye), 0.0, 1.0), 4.0);
    float shine = pow(max(dot(normal, normalize(kKeyLight + towardsEye)), 0.0), 24.0);
    vec3 light = 0.68 * key * kKeyColor + 0.16 * fill * kKeyColor + (0.28 + 0.16 * sky) * kSkyColor;
    return color * light + (0.25 * rim * (0.3 + 0.7 * sky)) * mix(color, vec3(1.0), 0.4) + gloss * 0.25 * shine;
}
