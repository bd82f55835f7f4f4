// Traction between two faces at one place, and its derivatives: a given pressure, and friction in the frame of the other face.
#pragma once

#include <memory>

#include "umform/assembly/history_variables.hpp"
#include "umform/contact/friction.hpp"
#include "umform/contact/sheets/foot.hpp"

namespace umform {

/// What a place of a face remembers of the other one: its foot, and the traction along it in the tangents there, so that both go
/// with the material.
struct SheetHistory {
    static constexpr VariableTable table{{{"held"},
                                          {"facet"},
                                          {"place", 2},
                                          {"gap"},
                                          {"traction", 2},
                                          {"slip"},
                                          {"stored"},
                                          {"friction work"},
                                          {"pressure"},
                                          {"contact energy"},
                                          {"contact work"},
                                          {"multiplier"},
                                          {"normal", 3}}};
    enum {
        Held = table["held"],
        Facet = table["facet"],
        Where = table["place"],
        Gap = table["gap"],
        Traction = table["traction"],
        Slip = table["slip"],
        Stored = table["stored"],
        Rubbed = table["friction work"],
        Pressure = table["pressure"],
        Energy = table["contact energy"],
        Work = table["contact work"],
        Multiplier = table["multiplier"],
        Normal = table["normal"]
    };
};

/// Friction between two sheets: a law for the bound, and the traction per elastic slip.
struct SheetFriction {
    std::shared_ptr<const FrictionLaw> law;  // none without friction
    double stiffness = 0.0;
};

/// Traction on the place, per area, and its derivatives: with respect to w = (d, h) of the foot, place less foot and normal, and
/// to w0 = (d, tau_1, tau_2) of the converged foot, which has gone with its facet.
struct SheetReaction {
    Vec3 traction{}, tangential{};
    Vec3 by_pressure{};             // derivative with respect to the pressure, which K keeps fixed
    std::array<Mat3, 2> K{};        // derivatives with respect to w ...
    std::array<Mat3, 3> K0{};       // ... and to w0
    double slid = 0.0, work = 0.0;  // way along the other face, and the work of the mean traction on it
    bool slips = false;
};

/// The converged foot, where it is now.
struct Anchor {
    bool known = false, held = false;
    double gap = 0.0, slip = 0.0;
    Vec3 d{};                          // place less the converged foot
    Vec3 above{};                      // what it was at the converged state, in contact
    std::array<Vec3, 2> tau{};         // tangents there
    std::array<double, 2> traction{};  // along them
};

namespace detail {

inline Mat3 outer(const Vec3& a, const Vec3& b) {
    Mat3 m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = a[i] * b[j];
    return m;
}

}  // namespace detail

/// Pressure p along the normal: t = p n. eq. (4.305)
template <int Nodes>
void press(const FacetFoot& foot, const FootMoves<Nodes>& moves, double pressure, SheetReaction& reaction) {
    for (int k = 0; k < 3; ++k) reaction.traction[k] = pressure * foot.n[k], reaction.by_pressure[k] = foot.n[k];
    for (int w = 0; w < 2; ++w)
        for (int i = 0; i < 9; ++i) reaction.K[w].a[i] = pressure * moves.n[w].a[i];
}

/// Friction: the converged traction, carried by the tangents of its foot, less stiffness times the way along the face since then or
/// since it touched, returned to the bound. eqs. (4.311) to (4.314)
template <int Nodes>
void rub(const SheetFriction& friction, const FacetFoot& foot, const FootMoves<Nodes>& moves, const Anchor& anchor,
         const Vec3& x, double pressure, SheetReaction& reaction) {
    const Vec3& n = foot.n;
    double part = 1.0, by_gap = 0.0;  // of the way, in contact
    if (!anchor.held) {
        part = anchor.known && anchor.gap > 0.0 && foot.gap < 0.0 ? foot.gap / (foot.gap - anchor.gap) : 0.0;
        if (part > 0.0) by_gap = -anchor.gap / ((foot.gap - anchor.gap) * (foot.gap - anchor.gap));
    }
    const double stiffness = friction.stiffness;
    Vec3 carried{}, way;
    for (int k = 0; k < 3; ++k) {
        carried[k] = anchor.traction[0] * anchor.tau[0][k] + anchor.traction[1] * anchor.tau[1][k];
        way[k] = part * anchor.d[k];
    }
    Vec3 q;
    for (int k = 0; k < 3; ++k) q[k] = carried[k] - stiffness * way[k];
    const double along = dot(n, q), along_way = dot(n, way);
    const Vec3 trial = across(q, n), slide = across(way, n), before = across(carried, n);
    const double size = std::sqrt(dot(trial, trial)), length = std::sqrt(dot(slide, slide));
    const Bound bound = friction.law->bound(std::max(pressure, 0.0), anchor.slip + length, x);
    reaction.slips = size > 0.0 && size > bound.value * (1.0 + 1e-12);
    Vec3 m{};
    if (reaction.slips)
        for (int k = 0; k < 3; ++k) m[k] = trial[k] / size;
    const double share = reaction.slips ? bound.value / size : 1.0;
    for (int k = 0; k < 3; ++k) reaction.tangential[k] = reaction.slips ? bound.value * m[k] : trial[k];

    // d(trial), d(length) by columns: dq -> P dq - (n.q) dn - n (q.dn).
    const auto add = [&](Mat3& into, const Mat3& dq, const Mat3& dway, const Mat3& dn) {
        for (int j = 0; j < 3; ++j) {
            Vec3 a, b, c;
            for (int i = 0; i < 3; ++i) a[i] = dq(i, j), b[i] = dway(i, j), c[i] = dn(i, j);
            const Vec3 Pa = across(a, n), Pb = across(b, n);
            const double qc = dot(q, c), wc = dot(way, c);
            Vec3 d_trial, d_slide;
            for (int i = 0; i < 3; ++i) {
                d_trial[i] = Pa[i] - along * c[i] - n[i] * qc;
                d_slide[i] = Pb[i] - along_way * c[i] - n[i] * wc;
            }
            if (reaction.slips) {
                const double d_length = length > 0.0 ? dot(slide, d_slide) / length : 0.0;
                const double ds = bound.by_slip * d_length, turn = dot(m, d_trial);
                for (int i = 0; i < 3; ++i) d_trial[i] = m[i] * ds + share * (d_trial[i] - m[i] * turn);
            }
            for (int i = 0; i < 3; ++i) into(i, j) += d_trial[i];
        }
    };
    for (int w = 0; w < 2; ++w) {
        Mat3 dq{}, dway{};
        if (by_gap != 0.0) {
            Vec3 d;
            for (int k = 0; k < 3; ++k) d[k] = by_gap * anchor.d[k];
            dway = detail::outer(d, moves.gap[w]);
            for (int i = 0; i < 9; ++i) dq.a[i] = -stiffness * dway.a[i];
        }
        add(reaction.K[w], dq, dway, moves.n[w]);
    }
    for (int w = 0; w < 3; ++w) {
        Mat3 dq{}, dway{};
        for (int k = 0; k < 3; ++k) {
            dq(k, k) = w == 0 ? -stiffness * part : anchor.traction[w - 1];
            dway(k, k) = w == 0 ? part : 0.0;
        }
        add(reaction.K0[w], dq, dway, Mat3{});
    }
    const Vec3 turned = across(anchor.above, n);
    for (int k = 0; k < 3; ++k) {
        reaction.traction[k] = reaction.tangential[k];
        if (reaction.slips) reaction.by_pressure[k] = bound.by_pressure * m[k];
        // With the work of the couple of tractions that act a gap apart. eq. (4.314)
        reaction.work -= 0.5 * (before[k] + reaction.tangential[k]) * (slide[k] - turned[k]);
    }
    reaction.slid = length;
}

}  // namespace umform
