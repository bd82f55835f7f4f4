// Lanes: one double for each of a few elements, worked on by one instruction. Kernels take their scalar type as a
// parameter; what is written here for `Lanes` is written for `double` too, so that they run with either.
//
// No lane sees another: what comes out of a lane does not depend on what is in the others, to the last bit.
#pragma once

#include <cmath>
#include <cstdint>

namespace umform {

/// Four doubles fill a register of AVX2, the instruction set that every x86-64 machine since 2013 has.
inline constexpr int lane_count = 4;

/// One truth value a lane; all bits of a lane are set, or none.
struct LaneMask {
    using Vector [[gnu::vector_size(8 * lane_count)]] = std::int64_t;
    Vector v;

    LaneMask() = default;
    LaneMask(Vector vector) : v(vector) {}
    LaneMask(bool every) : v(Vector{} - static_cast<std::int64_t>(every)) {}
    bool operator[](int lane) const { return v[lane] != 0; }
    void set(int lane, bool value) { v[lane] = value ? -1 : 0; }
    friend LaneMask operator&(LaneMask a, LaneMask b) { return a.v & b.v; }
    friend LaneMask operator|(LaneMask a, LaneMask b) { return a.v | b.v; }
    friend LaneMask operator!(LaneMask a) { return ~a.v; }
};

struct Lanes {
    using Vector [[gnu::vector_size(8 * lane_count)]] = double;
    Vector v;

    Lanes() = default;
    Lanes(Vector vector) : v(vector) {}
    Lanes(double every) : v(Vector{} + every) {}
    double operator[](int lane) const { return v[lane]; }
    void set(int lane, double value) { v[lane] = value; }
    Lanes& operator+=(Lanes b) { return v += b.v, *this; }
    Lanes& operator-=(Lanes b) { return v -= b.v, *this; }
    Lanes& operator*=(Lanes b) { return v *= b.v, *this; }
    friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
    friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
    friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
    friend Lanes operator-(Lanes a) { return -a.v; }
    friend LaneMask operator<(Lanes a, Lanes b) { return a.v < b.v; }
    friend LaneMask operator>(Lanes a, Lanes b) { return a.v > b.v; }
    friend LaneMask operator<=(Lanes a, Lanes b) { return a.v <= b.v; }
    friend LaneMask operator>=(Lanes a, Lanes b) { return a.v >= b.v; }
    friend LaneMask operator==(Lanes a, Lanes b) { return a.v == b.v; }
};

template <class Real>
struct Truth {
    using Type = bool;
};
template <>
struct Truth<Lanes> {
    using Type = LaneMask;
};
/// What a comparison of two `Real` gives.
template <class Real>
using Mask = typename Truth<Real>::Type;

inline bool any(bool mask) { return mask; }
inline bool any(LaneMask mask) {
    std::int64_t bits = 0;
    for (int lane = 0; lane < lane_count; ++lane) bits |= mask.v[lane];
    return bits != 0;
}
template <class Truths>
bool all(Truths mask) {
    return !any(!mask);
}

/// That of the first lane.
inline double leading(double x) { return x; }
inline double leading(Lanes x) { return x[0]; }
inline bool leading(bool mask) { return mask; }
inline bool leading(LaneMask mask) { return mask[0]; }

/// `yes` where the mask is set, else `no`.
inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
inline Lanes select(LaneMask mask, Lanes yes, Lanes no) { return mask.v ? yes.v : no.v; }

/// Calls function(lane) -> double for every lane.
template <class Function>
Lanes by_lane(const Function& function) {
    Lanes result;
    for (int lane = 0; lane < lane_count; ++lane) result.v[lane] = function(lane);
    return result;
}

/// function(x) of every lane, for functions that the library has for a double only.
template <class Function>
double each(double x, const Function& function) {
    return function(x);
}
template <class Function>
Lanes each(Lanes x, const Function& function) {
    return by_lane([&](int lane) { return function(x.v[lane]); });
}

using std::abs;
using std::pow;
using std::sqrt;
inline Lanes abs(Lanes x) {
    return each(x, [](double value) { return std::abs(value); });
}
inline Lanes sqrt(Lanes x) {
    return each(x, [](double value) { return std::sqrt(value); });
}
/// Always inlined: as a function of its own, which finds the upper halves of registers in use, each call of the library costs
/// several times as much.
[[gnu::always_inline]] inline Lanes pow(Lanes x, double exponent) {
    Lanes result;
    for (int lane = 0; lane < lane_count; ++lane) result.v[lane] = std::pow(x.v[lane], exponent);
    return result;
}

}  // namespace umform
