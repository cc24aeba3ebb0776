// How large a scene's numbers may be: so that sums of light stay finite as floats, even after the
// 64 mirrors that the longest chain of rays may meet. check_scene() and the readers of files agree
// on them; assets/scene.schema.json says them to users.
#pragma once

#include <limits>

namespace raypick {

inline constexpr double kLargestCoordinate = 1e18;  // beyond it float arithmetic would overflow

// The least number that is still positive as a float, and not denormal.
inline constexpr double kSmallestPositive = std::numeric_limits<float>::min();
inline constexpr double kMostLight = 1e18;          // colours of lights, glow and surroundings
inline constexpr double kMostSurfaceColour = 1e6;   // ambient, diffuse, specular
inline constexpr double kMostBounce = 2.0;          // reflect, transmit: beyond 1 light is made
inline constexpr double kMostAbsorption = 1e18;     // per unit of length
inline constexpr double kMostExponent = 1e18;       // shininess
inline constexpr double kLeastAttenuation = 1e-18;  // of what is not 0

}  // namespace raypick
