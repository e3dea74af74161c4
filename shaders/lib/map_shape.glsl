// How a point's place in the map follows from its place in the world; scene::LightFrustum does the same.

#ifdef PARABOLOID_MAP
// Half of all directions in one square, as a paraboloid reflects them: u and v are those of the direction, divided by 1
// plus its part along the axis. Depth is the distance.
// Source: Brabec, Annen and Seidel 2002, Shadow Mapping for Hemispherical and Omnidirectional Light Sources, CGI.
uniform vec2 paraboloid_center;
uniform float paraboloid_radius;  // of the circle that holds half of all directions
uniform float light_near_m;       // the distance of depth 0

vec4 find_in_map(vec3 position_ws) {
  vec3 way = position_ws - light_position_ws;
  precise float distance_m = length(way);
  precise vec3 direction = way / distance_m;
  precise float w = 1.0 + dot(direction, light_direction_ws);
  precise vec2 uv = paraboloid_center + paraboloid_radius * vec2(dot(direction, light_right_ws), dot(direction, light_up_ws)) / w;
  precise float depth = (distance_m - light_near_m) / depth_range_ws;
  return vec4(uv, depth, w);
}
#else
// u, v, depth, and the w that u and v were divided by.
vec4 find_in_map(vec3 position_ws) {
  precise vec4 place = uv_depth_from_world * vec4(position_ws, 1.0);
#if defined(PERSPECTIVE_LIGHT) || defined(WARPED_MAP)
  // Behind a light, where w < 0, this mirrors the map.
  place.xy /= place.w;
#elif defined(PROJECTIVE_MAP)
  place.xyz /= place.w;
#endif
#ifdef LOG_MAP
  place.y = log_scale * log(place.w) + log_offset;
#endif
  return place;
}
#endif

#if defined(WARPED_MAP) || defined(PARABOLOID_MAP)
#define CURVED_MAP
uniform float map_texels;  // along a side

// How u, v and depth change with a point's place: texels, and depth, for each metre.
struct MapGradients {
  vec3 u;
  vec3 v;
  vec3 depth;
};

#ifdef PARABOLOID_MAP
MapGradients find_gradients(vec3 position_ws) {
  vec3 way = position_ws - light_position_ws;
  float distance_m = length(way);
  vec3 direction = way / distance_m;
  float along = dot(direction, light_direction_ws), x = dot(direction, light_right_ws), y = dot(direction, light_up_ws);
  vec3 towards_axis = (light_direction_ws - along * direction) / (1.0 + along);
  float scale = map_texels * paraboloid_radius / ((1.0 + along) * distance_m);
  return MapGradients(scale * (light_right_ws - x * direction - x * towards_axis),
                      scale * (light_up_ws - y * direction - y * towards_axis), direction / depth_range_ws);
}
#else
MapGradients find_gradients(vec3 position_ws) {
  mat4 rows = transpose(uv_depth_from_world);
  vec4 place = uv_depth_from_world * vec4(position_ws, 1.0);
  float scale = map_texels / place.w;
  vec3 u = scale * (rows[0].xyz - (place.x / place.w) * rows[3].xyz);
#ifdef LOG_MAP
  return MapGradients(u, scale * log_scale * rows[3].xyz, rows[2].xyz);
#else
  return MapGradients(u, scale * (rows[1].xyz - (place.y / place.w) * rows[3].xyz), rows[2].xyz);
#endif
}
#endif

float texel_size_at(vec3 position_ws) {
  MapGradients along = find_gradients(position_ws);
  return inversesqrt(length(cross(along.u, along.v)));
}

// How the depth of a plane changes with a step of one texel along u and along v.
vec2 plane_along_texels(vec3 position_ws, vec3 normal_ws) {
  MapGradients along = find_gradients(position_ws);
  vec3 across = cross(along.u, along.v);
  float area = max(dot(normal_ws, across), 1e-4 * length(across));
  return vec2(dot(normal_ws, cross(along.depth, along.v)), dot(normal_ws, cross(along.u, along.depth))) / area;
}
#endif
