// Four moments of depth, x = 2 depth - 1 in [-1,1], and how little of it can lie before a receiver;
// filters/moments.h does the same.

const float root3 = 1.7320508075688772;

// The moments in a basis in which 16 bits lose least: two odd and two even polynomials that fill [0,1]. Peters et al.
// 2017, Improved Moment Shadow Maps for Translucent Occluders, Soft Shadows and Single Scattering, JCGT 6(1).
vec4 encode_moments(float depth) {
  float x = 2.0 * depth - 1.0;
  float square = x * x;
  return vec4(x * (1.5 - 2.0 * square) + 0.5, 4.0 * square * (1.0 - square),
              root3 * x * (0.5 - square * 2.0 / 9.0) + 0.5, 0.5 * square * (1.0 + square));
}

// What two blurs in 16 bits need at least.
float fit_moment_bias(float moment_bias) { return max(moment_bias, store_largest == 1.0 ? 1.2e-4 : 0.0); }

// E[x], E[x^2], E[x^3], E[x^4], moved a little towards those of a wide distribution, so that rounding cannot make them
// those of none.
vec4 decode_moments(vec4 stored, float moment_bias) {
  float first = stored.x - 0.5;
  float third = root3 * (stored.z - 0.5);
  vec4 moments = vec4(third - first / 3.0, stored.w + 0.125 * stored.y, 0.75 * (third - first),
                      stored.w - 0.125 * stored.y);
  return mix(moments, vec4(0.0, 0.375, 0.0, 0.375), moment_bias);
}

// The polynomial that is 1 / (the largest mass that can lie at x) there and 0 at the other two points of the
// distribution which has that mass: the solution of the moments' Hankel matrix for (1, x, x^2), by Cholesky.
vec3 solve_moments(vec4 b, float x) {
  float variance = b.y - b.x * b.x;
  float skew = (b.z - b.x * b.y) / variance;
  float rest = b.w - b.y * b.y - skew * (b.z - b.x * b.y);
  float c2 = (x * x - b.y - skew * (x - b.x)) / rest;
  float c1 = (x - b.x) / variance - skew * c2;
  return vec3(1.0 - c1 * b.x - c2 * b.y, c1, c2);
}

// The least share of any distribution with these moments that lies before x. Peters and Klein 2015, Moment Shadow
// Mapping, I3D (the Hamburger moment problem). Of the two other points, none, one or both lie before x; c says which.
float share_of_points(vec4 b, float x, vec3 c) {
  float mass = 1.0 / (c.x + x * (c.y + x * c.z));
  if (c.z >= 0.0) return c.y + 2.0 * c.z * x < 0.0 ? 0.0 : 1.0 - mass;
  float root = sqrt(c.y * c.y - 4.0 * c.x * c.z);
  return (0.5 * (1.0 - mass) * (c.y + root) + c.z * (b.x - mass * x)) / root;
}

// How far before x the points lie on the mean that `share_of_points` counts, of which there must be some: both others,
// or the nearer one, a root of the polynomial.
float distance_to_blockers(vec4 b, float x, vec3 c) {
  float mass = 1.0 / (c.x + x * (c.y + x * c.z));
  if (c.z >= 0.0) return (x - b.x) / (1.0 - mass);
  float root = sqrt(c.y * c.y - 4.0 * c.x * c.z);
  return x - (c.y < 0.0 ? 0.5 * (root - c.y) / c.z : -2.0 * c.x / (c.y + root));
}

// Whether one of the two other points lies outside [-1,1], where no depth is.
bool leaves_range(vec3 c) {
  float root = sqrt(max(c.y * c.y - 4.0 * c.x * c.z, 0.0));
  float far = -0.5 * (c.y + (c.y < 0.0 ? -root : root));
  float one = far / c.z;
  float other = c.x / far;
  return min(one, other) < -1.0 || max(one, other) > 1.0;
}

// The same of distributions over [-1,1]: with points at both ends, at x, and at one more. Peters and Klein 2015
// (the Hausdorff moment problem).
float share_with_ends(vec4 b, float x) {
  float free = ((b.y - b.w) - x * (b.x - b.z)) / ((b.x - b.z) - x * (1.0 - b.y));
  float sum = x + free;
  float product = x * free;
  if (free >= x)
    return (b.z - b.y * (sum + 1.0) + b.x * (product + sum) - product) / (-2.0 * (1.0 + x) * (1.0 + free));
  float at_x = (b.z - b.x - free * (b.y - 1.0)) / ((x * x - 1.0) * (x - free));
  float at_far = (b.z - b.y * (sum - 1.0) + b.x * (product - sum) + product) / (2.0 * (1.0 - x) * (1.0 - free));
  return 1.0 - at_x - at_far;
}

float share_before(vec4 b, float x) { return share_of_points(b, x, solve_moments(b, x)); }

float share_before_in_range(vec4 b, float x) {
  if (x <= -1.0) return 0.0;
  if (x > 1.0) return 1.0;
  x = min(x, 0.9999);  // at the ends points would meet
  vec3 c = solve_moments(b, x);
  return leaves_range(c) ? share_with_ends(b, x) : share_of_points(b, x, c);
}

// What the bias of the moments can have added to a share is taken off: the rest is a lower bound again.
float unbias_share(float share, float moment_bias) {
  return clamp((share - moment_bias) / (1.0 - moment_bias), 0.0, 1.0);
}
