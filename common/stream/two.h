#pragma once

#include "stream/elementary.h"

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__) || defined(_M_X64)
#define MULTIRES_SSE2
#include <emmintrin.h>
#endif

/// Two numbers that are worked on side by side, to the same last bit as one after the other. Every x86-64 can do that
/// at once; elsewhere it is left to the compiler.
namespace multires::stream {

#ifdef MULTIRES_SSE2

class Two {
public:
    Two() : v_(_mm_setzero_pd()) {}
    Two(double x) : v_(_mm_set1_pd(x)) {}
    Two(double a, double b) : v_(_mm_set_pd(b, a)) {}
    explicit Two(const double* x) : v_(_mm_loadu_pd(x)) {}
    void store(double* to) const { _mm_storeu_pd(to, v_); }
    double first() const { return _mm_cvtsd_f64(v_); }
    double second() const { return _mm_cvtsd_f64(_mm_unpackhi_pd(v_, v_)); }

    friend Two operator+(Two a, Two b) { return _mm_add_pd(a.v_, b.v_); }
    friend Two operator-(Two a, Two b) { return _mm_sub_pd(a.v_, b.v_); }
    friend Two operator*(Two a, Two b) { return _mm_mul_pd(a.v_, b.v_); }
    friend Two operator/(Two a, Two b) { return _mm_div_pd(a.v_, b.v_); }
    friend Two root(Two x) { return _mm_sqrt_pd(x.v_); }
    /// The larger one; b if a is no number.
    friend Two larger(Two a, Two b) { return _mm_max_pd(a.v_, b.v_); }
    /// The smaller one; b if a is no number.
    friend Two smaller(Two a, Two b) { return _mm_min_pd(a.v_, b.v_); }
    /// x where y > 0, else 0.
    friend Two where_positive(Two x, Two y) { return _mm_and_pd(x.v_, _mm_cmplt_pd(_mm_setzero_pd(), y.v_)); }
    /// x where y > 0, else z.
    friend Two where_positive(Two x, Two y, Two z) {
        const __m128d is = _mm_cmplt_pd(_mm_setzero_pd(), y.v_);
        return _mm_or_pd(_mm_and_pd(is, x.v_), _mm_andnot_pd(is, z.v_));
    }
    /// Numbers of less than 2^31 without what is behind the point.
    friend void store_whole(Two x, std::int64_t* to) {
        _mm_storeu_si128(to_bits(to), _mm_unpacklo_epi32(_mm_cvttpd_epi32(x.v_), _mm_setzero_si128()));
    }
    /// octave_steps(x, per_octave) + more, for 2 or 3 per octave and x from 2^-1022 on; none of the sums is negative.
    friend void store_octaves(Two x, int per_octave, int more, std::int64_t* to) {
        const __m128i bits = _mm_castpd_si128(x.v_), octave = _mm_srli_epi64(bits, 52);
        const __m128i one = _mm_castpd_si128(_mm_set1_pd(1));
        const __m128d m = _mm_castsi128_pd(_mm_or_si128(_mm_and_si128(bits, _mm_set1_epi64x(0x000fffffffffffff)), one));
        const auto reaches = [&](double least) { return _mm_castpd_si128(_mm_cmpge_pd(m, _mm_set1_pd(least))); };
        __m128i steps = _mm_add_epi64(_mm_add_epi64(octave, octave), _mm_set1_epi64x(more - per_octave * 1023));
        if (per_octave == 3) {
            steps = _mm_add_epi64(steps, octave);
            steps = _mm_sub_epi64(_mm_sub_epi64(steps, reaches(third_of_octave)), reaches(thirds_of_octave));
        } else {
            steps = _mm_sub_epi64(steps, reaches(half_of_octave));
        }
        _mm_storeu_si128(to_bits(to), steps);
    }

    /// exponential() of both.
    friend Two exponential(Two x) {
        x = smaller(larger(x, -40), 40);
        const __m128i n = _mm_cvttpd_epi32((x * 1.4426950408889634 + 64.5).v_);  // steps + 64
        const Two steps = Two(_mm_cvtepi32_pd(n)) - 64;
        const Two r = x - steps * 0.6931471805599453, rr = r * r;
        const Two sum = 1 + r + rr * (0.5 + r / 6 + rr * (1.0 / 24 + r / 120 + rr * (1.0 / 720)));
        const __m128i exponent = _mm_unpacklo_epi32(_mm_add_epi32(n, _mm_set1_epi32(1023 - 64)), _mm_setzero_si128());
        return sum * Two(_mm_castsi128_pd(_mm_slli_epi64(exponent, 52)));
    }
    /// logarithm() of both.
    friend Two logarithm(Two x) {
        const __m128i bits = _mm_castpd_si128(x.v_), one = _mm_castpd_si128(_mm_set1_pd(1));
        const __m128i fraction = _mm_and_si128(bits, _mm_set1_epi64x(0x000fffffffffffff));
        const Two m = _mm_castsi128_pd(_mm_or_si128(fraction, one));
        const __m128d above = _mm_cmpgt_pd(m.v_, _mm_set1_pd(1.4142135623730951));
        const Two half = m - Two(_mm_and_pd(above, (m * 0.5).v_));
        // 2^52 + the exponent's bits: a sum of doubles that is exact
        const __m128i high = _mm_castpd_si128(_mm_set1_pd(4503599627370496.0));
        const Two exponent = Two(_mm_castsi128_pd(_mm_or_si128(_mm_srli_epi64(bits, 52), high))) -
                             (4503599627370496.0 + 1023) + Two(_mm_and_pd(above, _mm_set1_pd(1)));
        const Two z = (half - 1) / (half + 1), zz = z * z;
        return exponent + 2.8853900817779268 * z * (1 + zz * (1.0 / 3 + zz * (0.2 + zz * (1.0 / 7 + zz / 9))));
    }

private:
    Two(__m128d v) : v_(v) {}
    static __m128i* to_bits(std::int64_t* to) { return reinterpret_cast<__m128i*>(to); }
    static constexpr double half_of_octave = 0x1.6a09e667f3bcdp0, third_of_octave = 0x1.428a2f98d728bp0,
                            thirds_of_octave = 0x1.965fea53d6e3dp0;
    __m128d v_;
};

#else

class Two {
public:
    Two() = default;
    Two(double x) : a_(x), b_(x) {}
    Two(double a, double b) : a_(a), b_(b) {}
    explicit Two(const double* x) : a_(x[0]), b_(x[1]) {}
    void store(double* to) const { to[0] = a_, to[1] = b_; }
    double first() const { return a_; }
    double second() const { return b_; }

    friend Two operator+(Two a, Two b) { return {a.a_ + b.a_, a.b_ + b.b_}; }
    friend Two operator-(Two a, Two b) { return {a.a_ - b.a_, a.b_ - b.b_}; }
    friend Two operator*(Two a, Two b) { return {a.a_ * b.a_, a.b_ * b.b_}; }
    friend Two operator/(Two a, Two b) { return {a.a_ / b.a_, a.b_ / b.b_}; }
    friend Two root(Two x) { return {std::sqrt(x.a_), std::sqrt(x.b_)}; }
    friend Two larger(Two a, Two b) { return {a.a_ > b.a_ ? a.a_ : b.a_, a.b_ > b.b_ ? a.b_ : b.b_}; }
    friend Two smaller(Two a, Two b) { return {a.a_ < b.a_ ? a.a_ : b.a_, a.b_ < b.b_ ? a.b_ : b.b_}; }
    friend Two where_positive(Two x, Two y) { return {y.a_ > 0 ? x.a_ : 0, y.b_ > 0 ? x.b_ : 0}; }
    friend Two where_positive(Two x, Two y, Two z) { return {y.a_ > 0 ? x.a_ : z.a_, y.b_ > 0 ? x.b_ : z.b_}; }
    friend void store_whole(Two x, std::int64_t* to) {
        to[0] = static_cast<std::int32_t>(x.a_), to[1] = static_cast<std::int32_t>(x.b_);
    }
    friend void store_octaves(Two x, int per_octave, int more, std::int64_t* to) {
        to[0] = octave_steps(x.a_, per_octave) + more, to[1] = octave_steps(x.b_, per_octave) + more;
    }
    friend Two exponential(Two x) { return {stream::exponential(x.a_), stream::exponential(x.b_)}; }
    friend Two logarithm(Two x) { return {stream::logarithm(x.a_), stream::logarithm(x.b_)}; }

private:
    double a_ = 0, b_ = 0;
};

#endif

inline Two& operator+=(Two& a, Two b) { return a = a + b; }

// The same for one number.
inline double root(double x) { return std::sqrt(x); }
inline double where_positive(double x, double y, double z = 0) { return y > 0 ? x : z; }

}  // namespace multires::stream
