/* Sines and cosines that a compiler can put into CasADi's code in place of calls of the C library: polynomials of degree 13 and 14 after a
   reduction by multiples of pi/2 in two parts. Right to a rounding of one where |x| is at most some 1e5; built with fused multiply-adds only. */
#ifndef PEER_SINE_H
#define PEER_SINE_H

#include <math.h>

#ifndef __FMA__
#error "the reduction needs fused multiply-adds"
#endif

/* sin(x + quarters pi/2) */
static inline __attribute__((always_inline)) double peer_sine(double x, int quarters)
{
  const double n = __builtin_rint(x * 0.6366197723675814);
  const double r = __builtin_fma(-n, 6.123233995736766e-17, __builtin_fma(-n, 1.5707963267948966, x)), z = r * r;
  const double s = -0.16666666666666666 + z * (0.008333333333330948 + z * (-0.00019841269836758574 + z * (2.755731610255244e-06
                   + z * (-2.5051131845003624e-08 + z * 1.5918129294866608e-10))));
  const double c = 0.041666666666666664 + z * (-0.0013888888888887398 + z * (2.480158729876569e-05 + z * (-2.7557317271729793e-07
                   + z * (2.08761462684032e-09 + z * -1.1382632425521717e-11))));
  const long long k = (long long)n + quarters;
  const double y = k & 1 ? 1 - 0.5 * z + z * z * c : r + r * z * s;
  return k & 2 ? -y : y;
}

#define sin(x) peer_sine(x, 0)
#define cos(x) peer_sine(x, 1)

#endif
