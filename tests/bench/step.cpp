// The limit: the step of step.py by hand with vector types, W lanes, one run per lane; constants of the matrices in consts.h.
#include <cmath>
#include <cstring>
#include <cstdint>
#include "consts.h"
#ifndef W
#define W 8
#endif
typedef double V __attribute__((vector_size(8 * W)));
typedef long long I __attribute__((vector_size(8 * W)));
static inline V S(double x) { return V{} + x; }
static inline V vmin(V a, V b) { return a < b ? a : b; }
static inline V vmax(V a, V b) { return a > b ? a : b; }
static inline V vabs(V a) { return (V)((I)a & 0x7FFFFFFFFFFFFFFFLL); }
static inline V vsqrt(V a) { V r; for (int i = 0; i < W; i++) r[i] = __builtin_sqrt(a[i]); return r; }
static inline V vrint(V a) { V r; for (int i = 0; i < W; i++) r[i] = __builtin_rint(a[i]); return r; }
static inline V vsin(V x) {
  V t = vrint(x * (1 / M_PI));
  V y = (x - t * 3.14159265358979312) - t * 1.2246467991473532e-16;
  V z = y * y;
  V p = ((((((S(-7.647e-13) * z + 1.605904e-10) * z - 2.5052108e-8) * z + 2.7557319e-6) * z - 1.98412698e-4) * z + 8.33333333e-3) * z - 0.16666666666666666);
  V s = y + y * z * p;
  V half = t * 0.5; V fl = vrint(half - 0.25);
  return (t - 2.0 * fl) > 0.5 ? -s : s;
}
#ifdef NOISE
static inline void draw(uint64_t k, uint64_t consumer, I run, uint64_t stream, uint64_t key, V* n) {
  typedef unsigned long long U __attribute__((vector_size(8 * W)));
  U x0 = U{} + k, x1 = U{} + consumer, x2 = (U)run, x3 = U{} + stream; uint64_t k0 = key & 0xffffffff, k1 = key >> 32;
#pragma GCC unroll 10
  for (int j = 0; j < 10; j++) {
    U p0 = x0 * 0xD2511F53ull, p1 = x2 * 0xCD9E8D57ull;
    U a = (p1 >> 32) ^ x1 ^ k0, b = (p0 >> 32) ^ x3 ^ k1; x1 = p1 & 0xffffffffull; x3 = p0 & 0xffffffffull; x0 = a; x2 = b;
    k0 = (k0 + 0x9E3779B9) & 0xffffffff; k1 = (k1 + 0xBB67AE85) & 0xffffffff;
  }
  U x[4] = {x0, x1, x2, x3}; V u[4];
  for (int j = 0; j < 4; j++) u[j] = ((V)(x[j] | 0x4330000000000000ull) - 4503599627370496.0 + 0.5) * 2.3283064365386963e-10;
  for (int j = 0; j < 2; j++) {
    V v = u[2 * j]; I b = (I)v; V e = (V)((((b >> 52) & 0x7ff) | 0x4330000000000000ll)) - 4503599627370496.0 - 1022.0;
    V m = (V)((b & ~0x7FF0000000000000ll) | 0x3FE0000000000000ll); auto sm = m < 0.70710678118654752440;
    V f = (sm ? 2 * m : m) - 1.0; e = e - (sm ? S(1.0) : S(0.0)); V s = f / (2.0 + f); V z = s * s; V h = 0.5 * f * f;
    V r = z * ((((((S(1.479819860510658591e-01) * z + 1.531383769920937332e-01) * z + 1.818357216161805012e-01) * z + 2.222219843214978396e-01) * z + 2.857142874366239149e-01) * z + 3.999999999940941908e-01) * z + 6.666666666666735130e-01);
    V lg = e * 6.93147180369123816490e-01 - ((h - (s * (h + r) + e * 1.90821492927058770002e-10)) - f);
    V rad = vsqrt(-2.0 * lg); V an = 6.283185307179586 * u[2 * j + 1];
    n[2 * j] = rad * vsin(an + 1.5707963267948966); n[2 * j + 1] = rad * vsin(an);
  }
}
#endif
extern "C" void fly(long n, long first, long last, const double* state_in, double* state_out, const double* cst, uint64_t key) {
  for (long o = 0; o < n; o += W) {
    V s[NS], c[NC];
    for (int i = 0; i < NS; i++) memcpy(&s[i], state_in + i * n + o, sizeof(V));
    for (int i = 0; i < NC; i++) memcpy(&c[i], cst + i * n + o, sizeof(V));
    V *x = s, *act = s + 4, *gust = s + 17, *obs = s + 19, &flt = s[24], &thr = s[25], *count = s + 26, *lat = s + 29, &alarm = s[32], &peak = s[33], *e = s + 34;
    const V *lim = c, *bias = c + 13; const V &amp = c[16], &om = c[17], &on = c[18], &lastc = c[19]; const V* mask = c + 20; const V &cmd = c[23], &scale = c[24]; const V *kn = c + 25, *va = c + 31; const V& sigma = c[37];
    I run; for (int i = 0; i < W; i++) run[i] = o + i;
    for (long k = first; k < last; k++) {
      const double DT = 0.01; double t = k * DT; V kk = S((double)k);
      V nrm[8];
#ifdef NOISE
      draw(k, 1, run, 1, key, nrm); draw(k, 2, run, 1, key, nrm + 4);
#else
      for (int i = 0; i < 8; i++) nrm[i] = s[i] ;
#endif
      V fy = kk >= on ? amp * vsin(om * (t - on * DT)) : S(0);
      V sn[3]; for (int j = 0; j < 3; j++) sn[j] = x[2] + nrm[j] * 0.01 + bias[j] * 0.01 + mask[j] * fy;
      V vot = vmin(vmin(vmax(sn[0], sn[1]), vmax(sn[1], sn[2])), vmax(sn[0], sn[2]));
      V r = va[0]; V tt = S(t);
      for (int j = 1; j < 6; j++) { V w = kn[j] - kn[j - 1]; V sh = (tt - kn[j - 1]) / (w > 0.0 ? w : S(1)); V in = va[j - 1] + vmin(sh, S(1)) * (va[j] - va[j - 1]); r = tt >= kn[j - 1] ? (tt >= kn[j] ? va[j] : in) : r; }
      V command = r * cmd;
      V fb[3] = {vot, x[3] + nrm[3] * 0.001, x[0]};
      for (int i = 0; i < 13; i++) { V d = LAW[i][0] * fb[0] + LAW[i][1] * fb[1] + LAW[i][2] * fb[2] + command * 0.1; V rate = vmin(vmax((d - act[i]) * RATE[i], -lim[i] * 4.0), lim[i] * 4.0); act[i] = vmin(vmax(act[i] + rate * DT, -lim[i]), lim[i]); }
      V g0 = gust[0] * 0.98 + nrm[4] * sigma, g1 = gust[1] * 0.97 + nrm[5] * sigma + gust[0] * 0.02; gust[0] = g0; gust[1] = g1;
      V r0 = x[0] * 0.1 * scale, r1 = x[1] * 0.1;
      V Am[4][4], dr[4];
      for (int i = 0; i < 4; i++) { for (int j = 0; j < 4; j++) Am[i][j] = A[0][i][j] + A[1][i][j] * r0 + A[2][i][j] * r1; dr[i] = S(0);
        for (int j = 0; j < 13; j++) if (B[0][i][j] != 0) dr[i] += (B[0][i][j] + B[1][i][j] * r0 + B[2][i][j] * r1) * act[j]; }
      dr[0] += g0 * 0.1; dr[1] += g1 * 0.1; dr[2] += g0 * 0.05;
      V kx[4][4], y[4];
      for (int i = 0; i < 4; i++) y[i] = x[i];
      for (int st = 0; st < 4; st++) { for (int i = 0; i < 4; i++) { kx[st][i] = dr[i]; for (int j = 0; j < 4; j++) kx[st][i] += Am[i][j] * y[j]; } if (st < 3) for (int i = 0; i < 4; i++) y[i] = x[i] + (st == 2 ? DT : 0.5 * DT) * kx[st][i]; }
      V ms[3] = {vot, fb[1], nrm[6] * 0.01}; V z[4] = {obs[0], obs[1], obs[2], obs[3]}; V err = vot - z[2], g = obs[4];
      for (int it = 0; it < 3; it++) { V h = vabs(g) + 0.1; g = g - (h * h * g - err) / (3.0 * h * h + 0.5); }
      V sig = err / (vabs(err) + 0.01);
      for (int i = 0; i < 4; i++) { V q = S(0); for (int j = 0; j < 4; j++) q += A_O[i][j] * z[j]; for (int j = 0; j < 3; j++) q += B_O[i][j] * ms[j]; q += L_O[i] * err; obs[i] = z[i] + DT * (q + sig * 0.2); }
      obs[4] = g;
      for (int i = 0; i < 4; i++) x[i] = x[i] + (DT / 6) * (kx[0][i] + 2.0 * kx[1][i] + 2.0 * kx[2][i] + kx[3][i]);
      V flt0 = flt, thr0 = thr; V fltn = flt0 * 0.95 + 0.05 * vabs(err), thrn = thr0 * 0.999 + 0.001 * (1.0 + vsqrt(g0 * g0 + g1 * g1)); V nf = S(0);
      for (int j = 0; j < 3; j++) { V dv = vabs(sn[j] - vot); count[j] = dv > thrn * 0.5 ? count[j] + 1.0 : vmax(count[j] - 1.0, S(0)); lat[j] = (count[j] > 30.0) & (kk < lastc) ? S(1) : lat[j]; e[j] = e[j] * 0.9 + dv * dv; nf += lat[j]; }
      alarm = (alarm == 0.0) & (nf > 0.0) ? kk : alarm; peak = kk < lastc ? vmax(peak, fltn / thrn) : peak; flt = fltn; thr = thrn;
    }
    for (int i = 0; i < NS; i++) memcpy(state_out + i * n + o, &s[i], sizeof(V));
  }
}
