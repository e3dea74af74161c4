// The end of a lookup whose first taps agree: some save the rest. A filter that includes this declares a parameter
// `bail` with the choices of filters/poisson.glsl; filters/penumbra.h does the same.

const int first_taps = 4;

// The tap of so many that comes i-th: with a bail the last first. Those of a spiral lie at its rim, where all that
// differs within the disk is likely to show; those of other patterns need not.
int order_tap(int i, int count) { return bail == BAIL_AGREE ? count - 1 - i : i; }

// Whether the first taps, of which i is the last so far, are all lit or all blocked.
bool agrees(int i, float sum) {
  return bail == BAIL_AGREE && i + 1 == first_taps && (sum == 0.0 || sum == float(first_taps));
}
