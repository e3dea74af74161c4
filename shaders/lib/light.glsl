// The light, its map, and the run's bias; the same uniforms in every pass that asks where a point lies in the map.
uniform mat4 uv_depth_from_world;
uniform vec3 light_direction_ws;   // the way the light travels
uniform vec3 light_right_ws;       // world direction of +u
uniform vec3 light_up_ws;          // world direction of +v
uniform float texel_size_ws;
uniform float depth_range_ws;
uniform float light_size;
uniform float bias_constant;       // depth; the larger of this and the next holds
uniform float bias_slope;          // depth, times 1 - n.l
uniform float bias_plane_texels;
uniform float bias_plane_kernels;   // the share of that per texel of a filter's reach
uniform float bias_normal_texels;
uniform float bias_max_tangent;    // steeper planes are treated as this steep

// The direction from a point to the light's centre, unit length.
vec3 direction_to_light(vec3 position_ws) { return -light_direction_ws; }
