// The return map of any smooth yield function: Newton's method with a line search on stress and plastic increment, and stages of a
// shrinking yield surface where that does not converge. docs/theory, 3.12
#pragma once

#include "umform/materials/plastic_increment.hpp"
#include "umform/materials/staged_returns.hpp"

namespace umform {

/// Cholesky factors L D L^T of a symmetric positive definite 5x5 matrix.
template <class Real>
struct Factors5 {
    Mat<Real, 5, 5> L;
    Vec<Real, 5> inverse;  // of the pivots

    explicit Factors5(const Mat<Real, 5, 5>& M) {
        for (int j = 0; j < 5; ++j) {
            Real d = M(j, j);
            for (int k = 0; k < j; ++k) d -= L(j, k) * L(j, k) * pivot_[k];
            pivot_[j] = d;
            inverse[j] = 1.0 / d;
            for (int i = j + 1; i < 5; ++i) {
                Real sum = M(i, j);
                for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k) * pivot_[k];
                L(i, j) = sum * inverse[j];
            }
        }
    }

    Deviator<Real> solve(Deviator<Real> b) const {
        for (int i = 1; i < 5; ++i)
            for (int k = 0; k < i; ++k) b[i] -= L(i, k) * b[k];
        for (int i = 4; i >= 0; --i) {
            b[i] *= inverse[i];
            for (int k = i + 1; k < 5; ++k) b[i] -= L(k, i) * b[k];
        }
        return b;
    }

  private:
    Vec<Real, 5> pivot_;
};

/// The equations at a stress xi and an increment dp, with their derivatives. eq. (3.89)
template <class Real>
struct GeneralReturn : PlasticIncrement<Real> {
    Deviator<Real> xi, n, R, v;  // v: dR/d(dp)
    Mat<Real, 5, 5> M, G;        // dR/dxi; ds/dxi with s = xi + back stresses
    Deviator<Real> s, ds;        // stress, and its derivative by dp at the same xi
    Real phi, f, merit;

    template <class Yield>
    GeneralReturn(const MetalParts& metal, const Yield& yield, const PlasticStart<Real>& start,
                  const Deviator<Real>& stress, Real dp, Real stage)
        : PlasticIncrement<Real>(metal, start, dp), xi(stress) {
        yield.derivatives(xi, phi, n, M);
        for (int i = 0; i < 5; ++i) {
            s[i] = this->k * xi[i] + this->back.A[i];
            ds[i] = this->dk * xi[i] + this->back.dA[i];
            for (int j = 0; j < 5; ++j) G(i, j) = i == j ? this->k : Real(0.0);
        }
        if (metal.two_surfaces.active()) {
            const InnerBackStress<Real> inner(metal.two_surfaces, start.stagnation.grown, start.inner, xi, dp);
            for (int i = 0; i < 5; ++i) {
                s[i] += inner.alpha[i];
                ds[i] += inner.by_dp[i];
                for (int j = 0; j < 5; ++j)
                    G(i, j) += inner.rank_one * inner.z[i] * inner.z[j] + (i == j ? inner.identity : Real(0.0));
            }
        }
        const Real way = this->shear * dp, rate = this->shear + this->dshear * dp;
        f = phi - stage * this->y.value;
        merit = f * f;
        for (int i = 0; i < 5; ++i) {
            R[i] = s[i] + way * n[i] - this->shear * start.e[i];
            v[i] = ds[i] + rate * n[i] - this->dshear * start.e[i];
            merit += R[i] * R[i];
            for (int j = 0; j < 5; ++j) M(i, j) = way * M(i, j) + G(i, j);
        }
    }
};

/// Newton's method on the equations of a stage, a factor of the yield stress: from xi and dp as they are to the solution, where
/// `open`. Leaves the lanes without one in the mask; where there is none left, the equations at the solution. eqs. (3.90), (3.91)
template <class Real, class Yield>
GeneralReturn<Real> solve_stage(const MetalParts& metal, const Yield& yield, const PlasticStart<Real>& start,
                                Real stage, Deviator<Real>& xi, Real& dp, Mask<Real>& open, Seen seen) {
    constexpr int most_evaluations = 60;
    constexpr double least_fall = 1e-4;  // of the residual, as a share of what the step promises
    const bool rated = metal.rate.active();
    GeneralReturn<Real> at(metal, yield, start, xi, dp, stage);
    const Real size = at.shear * at.shear * dot(start.e, start.e) + at.y.value * at.y.value;
    const Real solved = 1e-28 * size;
    Deviator<Real> toward{0.0, 0.0, 0.0, 0.0, 0.0};
    Real change = 0.0, part = 1.0, merit = at.merit;
    Mask<Real> accepted = true;
    for (int evaluation = 0; evaluation < most_evaluations; ++evaluation) {
        const Mask<Real> moved = open & accepted;
        for (int i = 0; i < 5; ++i) xi[i] = select(moved, at.xi[i], xi[i]);
        dp = select(moved, at.dp, dp);
        merit = select(moved, at.merit, merit);
        if (seen && leading(moved)) seen->push_back(std::sqrt(leading(merit / size)));
        open = open & !(merit <= solved);
        if (!any(open)) return at;
        const Factors5<Real> factors(at.M);
        const Deviator<Real> by_R = factors.solve(at.R), by_v = factors.solve(at.v);
        const Real step = (at.f - dot(at.n, by_R)) / (stage * at.y.slope + dot(at.n, by_v));
        for (int i = 0; i < 5; ++i) toward[i] = select(moved, -by_R[i] - step * by_v[i], toward[i]);
        // Never back to a negative increment.
        change = select(moved, rated ? step : select(dp + step < 0.0, -0.5 * dp, step), change);
        part = select(moved, 1.0, 0.5 * part);
        Deviator<Real> next;
        for (int i = 0; i < 5; ++i) next[i] = xi[i] + select(open, part * toward[i], 0.0);
        const Real way = select(open, part * change, 0.0);
        at = GeneralReturn<Real>(metal, yield, start, next, rated ? step_positive(dp, way) : dp + way, stage);
        accepted = (at.merit <= (1.0 - 2.0 * least_fall * part) * merit) | (at.merit <= solved);
    }
    return at;
}

/// Where the increment of a metal with a rate starts: below what elasticity allows, and what its factor does. eq. (3.123)
template <class Real>
Real rated_start(const MetalParts& metal, const PlasticStart<Real>& start, Real over, Real elastic) {
    const Real excess = select(over > 1.0, over - 1.0, 0.0), most = metal.rate.reach(excess, start.step);
    return select(most < elastic, most, elastic);
}

/// Newton from the point of the surface on the ray to the trial stress; where that fails, in stages from the surface through the
/// trial stress, on which it is the solution. eqs. (3.89)-(3.92)
template <class Real, class Yield>
PlasticFlow<Real> general_return_map(const MetalParts& metal, const Yield& yield, const PlasticStart<Real>& start,
                                     Mask<Real> plastic, Seen seen = nullptr) {
    constexpr double shrink = 0.7;
    const bool rated = metal.rate.active();
    Deviator<Real> xi, n;
    Real dp, elastic, over;  // elastic: the increment without a rate; over: trial stress over yield stress
    {
        const PlasticIncrement<Real> none(metal, start, 0.0);
        Mat<Real, 5, 5> N;
        for (int i = 0; i < 5; ++i) xi[i] = none.b[i] - start.inner[i];
        yield.derivatives(xi, over, n, N);
        const Real slope = rated ? 0.0 : none.y.slope;  // that of a rate is infinite
        dp = elastic = select(plastic, (over - none.y.value) / (slope + none.shear * dot(n, n)), 0.0);
        over = select(plastic, over / none.y.value, 1.0);
        Real first = 1.0 / over;
        if (rated) {
            dp = rated_start<Real>(metal, start, over, dp);
            first = first * metal.rate(dp, start.step).value;
            first = select(first < 1.0, first, 1.0);
        }
        for (int i = 0; i < 5; ++i) xi[i] = first * xi[i];
    }
    Mask<Real> open = plastic;
    GeneralReturn<Real> at = solve_stage<Real>(metal, yield, start, 1.0, xi, dp, open, seen);
    Mask<Real> found = !open;
    if (any(open)) {
        Mask<Real> staged = open;
        note_stages(staged);
        const PlasticIncrement<Real> none(metal, start, 0.0);
        for (int i = 0; i < 5; ++i) xi[i] = select(staged, none.b[i] - start.inner[i], xi[i]);
        dp = select(staged, rated ? rated_start<Real>(metal, start, 1.0 / shrink, elastic) : Real(0.0), dp);
        Real stage = select(staged, over, 1.0);
        while (any(staged)) {
            stage = select(shrink * stage > 1.0, shrink * stage, 1.0);
            open = staged;
            solve_stage<Real>(metal, yield, start, stage, xi, dp, open, seen);
            staged = staged & !open;
            found = found | (staged & (stage == 1.0));
            staged = staged & (stage > 1.0);
        }
        at = GeneralReturn<Real>(metal, yield, start, xi, dp, 1.0);
    }

    // eq. (3.93)
    const Factors5<Real> factors(at.M);
    const Deviator<Real> by_n = factors.solve(at.n), by_v = factors.solve(at.v);
    const Real rate = at.shear / (at.y.slope + dot(at.n, by_v));
    PlasticFlow<Real> flow;
    flow.xi = at.xi;
    flow.plastic = plastic;
    flow.found = found;
    flow.dp = dp;
    flow.n = at.n;
    for (int j = 0; j < 5; ++j) {
        flow.s[j] = at.s[j];
        flow.dp_by_strain[j] = rate * by_n[j];
    }
    for (int j = 0; j < 5; ++j) {
        Deviator<Real> unit{0.0, 0.0, 0.0, 0.0, 0.0};
        unit[j] = at.shear;
        unit = factors.solve(unit);
        for (int i = 0; i < 5; ++i) unit[i] -= by_v[i] * flow.dp_by_strain[j];  // dxi/de
        for (int i = 0; i < 5; ++i) {
            Real sum = at.ds[i] * flow.dp_by_strain[j];
            for (int l = 0; l < 5; ++l) sum += at.G(i, l) * unit[l];
            flow.tangent(i, j) = sum;
        }
    }
    return flow;
}

}  // namespace umform
