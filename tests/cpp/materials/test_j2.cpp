// J2: the elastic fast path against the path by principal stretches, its tangent, and lanes that go different ways.
#include <random>

#include "check.hpp"
#include "umform/materials/j2.hpp"

using namespace umform;

namespace {

std::mt19937 generator(7);
double normal() { return std::normal_distribution<double>()(generator); }

const J2 law{175e3, 80.77e3, LinearVoce{160, 500, 160, 0}};
const J2 elastic_law{175e3, 80.77e3, LinearVoce{1e9, 0, 1e9, 0}};

struct Answer {
    Voigt S;
    Voigt66 CC;
    std::array<double, J2::size> trial;
};

/// A plastic metric of determinant one, and a strain whose elastic part is `size`.
void random_state(double size, double plastic, Voigt& E, std::array<double, J2::size>& state) {
    Mat3 F{{1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (double& entry : F.a) entry += plastic * normal();
    const double scale = std::cbrt(1.0 / det(F));
    for (double& entry : F.a) entry *= scale;
    Mat3 P, e;  // P = F F^T, C = F^-T (1 + 2 e) F^-1
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) P(i, j) += F(i, k) * F(j, k);
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) e(i, j) = e(j, i) = size * normal();
    const Mat3 G = inverse(F);
    for (int p = 0; p < 6; ++p) {
        const auto [i, j] = voigt_pair[p];
        state[J2::Metric + p] = P(i, j);
        double metric = i == j ? -1.0 : 0.0, strain = 0.0;
        for (int k = 0; k < 3; ++k) {
            metric += G(k, i) * G(k, j);
            for (int l = 0; l < 3; ++l) strain += G(k, i) * e(k, l) * G(l, j);
        }
        E[p] = (p < 3 ? 1.0 : 2.0) * (0.5 * metric + strain);
    }
    state[J2::Eqps] = 0.01;
}

double largest(const auto& values) {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
}

void check_fast_path() {
    for (const double plastic : {0.0, 0.02, 0.3})
        for (const double size : {1e-12, 1e-8, 1e-5, 1e-3, 2e-3, 4e-3})
            for (int sample = 0; sample < 50; ++sample) {
                Voigt E;
                std::array<double, J2::size> state;
                random_state(size, plastic, E, state);
                Answer fast, roots;
                CHECK(elastic_law.respond(E, state.data(), fast.S, fast.CC, fast.trial.data()));
                const auto y = yield_stress(elastic_law.hardening, state[J2::Eqps]);
                CHECK(elastic_law.respond_by_roots(E, state.data(), y, roots.S, roots.CC, roots.trial.data()));
                // Elastic strains that are differences of metrics have the absolute accuracy of their round-off.
                const double metrics = 1.0 + 100.0 * plastic;
                const double of_stress =
                    1e-14 * metrics * largest(roots.S) + (plastic > 0.0 ? 4e-15 * metrics * law.kappa : 0.0);
                for (int p = 0; p < 6; ++p) CHECK_NEAR(fast.S[p], roots.S[p], of_stress);
                for (int i = 0; i < 36; ++i)
                    CHECK_NEAR(fast.CC.a[i], roots.CC.a[i], 1e-14 * metrics * largest(roots.CC.a));
                for (int k = 0; k < J2::size; ++k) CHECK_NEAR(fast.trial[k], state[k], 0.0);
            }
}

/// CC against central differences of S, in the fast path.
void check_fast_tangent() {
    for (int sample = 0; sample < 20; ++sample) {
        Voigt E;
        std::array<double, J2::size> state;
        random_state(2e-3, 0.2, E, state);
        Answer at;
        CHECK(elastic_law.respond(E, state.data(), at.S, at.CC, at.trial.data()));
        for (int q = 0; q < 6; ++q) {
            const double step = 1e-5;
            Answer side;
            Voigt forward, backward, there = E;
            there[q] += step;
            elastic_law.respond(there, state.data(), forward, side.CC, side.trial.data());
            there[q] -= 2.0 * step;
            elastic_law.respond(there, state.data(), backward, side.CC, side.trial.data());
            for (int p = 0; p < 6; ++p)
                CHECK_NEAR((forward[p] - backward[p]) / (2.0 * step), at.CC(p, q), 1e-8 * largest(at.CC.a));
        }
    }
}

/// An elastic, a plastic, a large and an inverted strain side by side: each lane answers as if it were alone.
void check_lanes() {
    std::array<Voigt, lane_count> E;
    std::array<std::array<double, J2::size>, lane_count> states;
    for (int lane = 0; lane < lane_count; ++lane)
        random_state(std::array{1e-4, 5e-3, 0.1, 0.0}[lane % 4], 0.1, E[lane], states[lane]);
    E[3] = {-0.7, 0, 0, 0, 0, 0};
    const auto ask = [&](const std::array<int, lane_count>& who, Vec<Lanes, 6>& S, Mat<Lanes, 6, 6>& CC,
                         std::array<Lanes, J2::size>& trial) {
        Vec<Lanes, 6> strain;
        std::array<Lanes, J2::size> state;
        for (int p = 0; p < 6; ++p) strain[p] = by_lane([&](int lane) { return E[who[lane]][p]; });
        for (int k = 0; k < J2::size; ++k) state[k] = by_lane([&](int lane) { return states[who[lane]][k]; });
        return law.respond(strain, state.data(), S, CC, trial.data());
    };
    Vec<Lanes, 6> S, S_alone;
    Mat<Lanes, 6, 6> CC, CC_alone;
    std::array<Lanes, J2::size> trial, trial_alone;
    std::array<int, lane_count> who;
    for (int lane = 0; lane < lane_count; ++lane) who[lane] = lane;
    const LaneMask good = ask(who, S, CC, trial);
    CHECK(good[0] && good[1] && good[2] && !good[3]);
    for (int lane = 0; lane < 3; ++lane) {
        who.fill(lane);
        CHECK(ask(who, S_alone, CC_alone, trial_alone)[0]);
        CHECK(lane == 0 ? trial[J2::Eqps][lane] == 0.01 : trial[J2::Eqps][lane] > 0.01);
        for (int p = 0; p < 6; ++p) CHECK_NEAR(S[p][lane], S_alone[p][0], 0.0);
        for (int i = 0; i < 36; ++i) CHECK_NEAR(CC.a[i][lane], CC_alone.a[i][0], 0.0);
        for (int k = 0; k < J2::size; ++k) CHECK_NEAR(trial[k][lane], trial_alone[k][0], 0.0);
    }
}

/// A curve so steep that Newton's method reaches its next piece only in each iteration: 130 pieces, each 200 times as long as the
/// one before. The return map gives up, and says so in the lanes that it cannot answer for.
void check_unsolved() {
    Tabulated steep;
    for (int k = 0; k < 130; ++k) {
        steep.eqps.push_back(k == 0 ? 0.0 : 1e-300 * std::pow(200.0, k));
        steep.stress.push_back(100.0 + 10.0 * k);
    }
    const J2 brittle{175e3, 80.77e3, steep};
    std::array<double, J2::size> virgin;
    brittle.initial(virgin.data());
    const Voigt elastic{1e-5, 0, 0, 0, 0, 0}, plastic{6.6e-3, -3.3e-3, -3.3e-3, 0, 0, 0};
    Answer at;
    CHECK(brittle.respond(elastic, virgin.data(), at.S, at.CC, at.trial.data()));
    CHECK(!brittle.respond(plastic, virgin.data(), at.S, at.CC, at.trial.data()));
    Vec<Lanes, 6> strain, S;
    Mat<Lanes, 6, 6> CC;
    std::array<Lanes, J2::size> state, trial;
    for (int p = 0; p < 6; ++p) strain[p] = by_lane([&](int lane) { return lane == 2 ? plastic[p] : elastic[p]; });
    for (int k = 0; k < J2::size; ++k) state[k] = virgin[k];
    const LaneMask answered = brittle.respond(strain, state.data(), S, CC, trial.data());
    for (int lane = 0; lane < lane_count; ++lane) CHECK(answered[lane] == (lane != 2));
    const J2 nameless{175e3, 80.77e3, LinearVoce{160.0, std::nan(""), 160.0, 0.0}};
    CHECK(!nameless.respond(plastic, virgin.data(), at.S, at.CC, at.trial.data()));
}

}  // namespace

int main() {
    check_unsolved();
    check_fast_path();
    check_fast_tangent();
    check_lanes();
    return report("j2");
}
