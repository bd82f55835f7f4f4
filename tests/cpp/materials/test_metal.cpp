// Metals: yield functions against differences, and what a return map finds against the equations of the theory written out here: flow,
// back stresses, two surfaces and their stagnation, falling modulus, rates, work; tangents against differences.
#include <random>

#include "check.hpp"
#include "umform/materials/metal.hpp"
#include "umform/materials/yield/quadratic.hpp"
#include "umform/materials/yield/yld2004.hpp"

using namespace umform;

namespace {

std::mt19937 generator(11);
double normal() { return std::normal_distribution<double>()(generator); }

constexpr double kappa = 175e3, mu = 80e3, time_step = 0.25;
const Hardening voce = LinearVoce{130, 0, 300, 12}, perfect = LinearVoce{124, 0, 124, 0};
const Chaboche two{{{9000, 120}, {800, 8}}, 0.43, 6.0};
const FallingModulus falling{0.25, 40};
const TwoSurfaces spcc{500, 168, 190, 12, 0.5, 124};
const RateFactor johnson_cook{RateFactor::Kind::JohnsonCook, 1e-3, 0.02},
    cowper_symonds{RateFactor::Kind::CowperSymonds, 40, 0.2};

/// AA2090-T3, Barlat et al. (2005), table 2.
Yld2004<8> aa2090() {
    return {8,
            {-0.069888, 0.936408, 0.079143, 1.003060, 0.524741, 1.363180, 0.954322, 1.023770, 1.069060},
            {0.981171, 0.476741, 0.575316, 0.866827, 1.145010, -0.079294, 1.404620, 1.051660, 1.147100}};
}
QuadraticYield hill() { return QuadraticYield::hill(0.3, 0.36, 0.64, 1.5, 1.5, 1.3); }

Voigt random_strain(double size) {
    Voigt h;
    for (double& component : h) component = size * normal();
    return h;
}

/// Value of Hosford's function on the axes; gradient and Hessian against differences; degree one.
void check_yield_functions() {
    constexpr std::array<double, 9> ones{1, 1, 1, 1, 1, 1, 1, 1, 1};
    const Yld2004<8> hosford(8, ones, ones);
    const Deviator<double> axes = hosford.basis.components(Voigt{120, -50, 30, 0, 0, 0}, 1.0);
    const double sum = std::pow(170, 8) + std::pow(80, 8) + std::pow(90, 8);
    CHECK_NEAR(hosford.value(axes) / std::pow(0.5 * sum, 0.125), 1.0, 1e-14);
    const auto derivatives = [](const auto& yield) {
        for (int sample = 0; sample < 20; ++sample) {
            Deviator<double> xi, n, ahead, behind;
            for (double& component : xi) component = 100.0 * normal();
            Mat<double, 5, 5> N, unused;
            double phi, up, down, along = 0.0;
            yield.derivatives(xi, phi, n, N);
            for (int j = 0; j < 5; ++j) {
                constexpr double step = 1e-3;
                Deviator<double> there = xi;
                there[j] += step;
                yield.derivatives(there, up, ahead, unused);
                there[j] -= 2.0 * step;
                yield.derivatives(there, down, behind, unused);
                CHECK_NEAR(n[j], (up - down) / (2.0 * step), 1e-8);
                for (int i = 0; i < 5; ++i) CHECK_NEAR(N(i, j), (ahead[i] - behind[i]) / (2.0 * step), 1e-9);
                along += n[j] * xi[j];
            }
            CHECK_NEAR(along / phi, 1.0, 1e-13);
        }
    };
    derivatives(hosford);
    derivatives(aa2090());
    derivatives(hill());
}

template <class Yield>
struct Point {
    Metal<Yield> metal;
    std::vector<double> before, after;
    Voigt h{}, T{};
    Voigt66 C;

    Point(const MetalParts& parts, const Yield& yield)
        : metal(parts, yield), before(metal.table.size()), after(metal.table.size()) {
        metal.initial(after.data());
    }
    void advance(const Voigt& change, double step = time_step) {
        before = after;
        for (int p = 0; p < 6; ++p) h[p] += change[p];
        CHECK(metal.respond(h, before.data(), T, C, after.data(), step));
    }
    Deviator<double> deviator(const std::vector<double>& state, int place) const {
        Voigt t;
        std::copy_n(state.begin() + place, 6, t.begin());
        return metal.yield.basis.components(t, 1.0);
    }
    Deviator<double> stress() const { return metal.yield.basis.components(T, 1.0); }
    double eqps() const { return after[MetalHistory::Eqps]; }
    double dp() const { return eqps() - before[MetalHistory::Eqps]; }

    /// CC against central differences from the state before.
    void check_tangent() const {
        double size = 0.0;
        for (const double entry : C.a) size = std::max(size, std::abs(entry));
        for (int q = 0; q < 6; ++q) {
            constexpr double step = 1e-7;
            Voigt ahead, behind, there = h;
            Voigt66 unused;
            std::vector<double> trial(after.size());
            there[q] += step;
            metal.respond(there, before.data(), ahead, unused, trial.data(), time_step);
            there[q] -= 2.0 * step;
            metal.respond(there, before.data(), behind, unused, trial.data(), time_step);
            for (int p = 0; p < 6; ++p) CHECK_NEAR(C(p, q), (ahead[p] - behind[p]) / (2.0 * step), 1e-6 * size);
        }
    }
};

double rate_factor(const RateFactor& rate, double dp) {
    if (!rate.active()) return 1.0;
    const double ratio = dp / time_step / rate.reference;
    if (rate.kind == RateFactor::Kind::CowperSymonds) return 1.0 + std::pow(ratio, rate.strength);
    return 1.0 + rate.strength * std::log(std::max(ratio, 1.0));
}

/// Back stresses, elasticity, flow and size of the yield surface behind random increments. eqs. (3.73)-(3.76), (3.120)-(3.122)
template <class Yield>
void check_chaboche(const Yield& yield, const RateFactor& rate) {
    for (int sample = 0; sample < 10; ++sample) {
        const MetalParts parts{kappa, mu, voce, two, falling, {}, rate};
        Point<Yield> at(parts, yield);
        for (int increment = 0; increment < 3; ++increment) {
            at.advance(random_strain(std::array{1e-2, 3e-2, 4e-3}[increment]));
            const double p = at.eqps(), dp = at.dp(), share = 1.0 + (0.43 - 1.0) * std::exp(-6.0 * p);
            CHECK(dp > 0.0);
            Deviator<double> xi = at.stress(), n;
            for (int part = 0; part < 2; ++part)
                for (int i = 0; i < 5; ++i) xi[i] -= at.deviator(at.after, at.metal.table.back_stress[part])[i];
            double phi;
            yield.gradient(xi, phi, n);
            const double y = (300.0 - 170.0 * std::exp(-12.0 * p)) * rate_factor(rate, dp);
            CHECK_NEAR(phi / y, 1.0, 1e-12);
            for (int part = 0; part < 2; ++part) {
                const auto [modulus, recall] = two.parts[part];
                const int place = at.metal.table.back_stress[part];
                const auto now = at.deviator(at.after, place), then = at.deviator(at.before, place);
                for (int i = 0; i < 5; ++i)
                    CHECK_NEAR(now[i] - then[i], dp * (modulus * share * xi[i] / phi - recall * now[i]), 1e-9);
            }
            Voigt elastic, flow;
            for (int k = 0; k < 6; ++k) {
                const int place = MetalHistory::PlasticStrain + k;
                elastic[k] = at.h[k] - at.after[place], flow[k] = at.after[place] - at.before[place];
            }
            const double modulus = 1.0 - 0.25 * (1.0 - std::exp(-40.0 * p));
            const auto e = yield.basis.components(elastic, 0.5), de = yield.basis.components(flow, 0.5);
            for (int i = 0; i < 5; ++i) {
                CHECK_NEAR(at.stress()[i], 2.0 * mu * modulus * e[i], 1e-8);
                CHECK_NEAR(de[i], dp * n[i], 1e-13);
            }
            CHECK_NEAR((at.T[0] + at.T[1] + at.T[2]) / 3.0, kappa * modulus * (at.h[0] + at.h[1] + at.h[2]), 1e-8);
            at.check_tangent();
        }
    }
}

/// Gain of the energies over the work along a path beyond yield, less one: elastic, of the curve, of back stresses, modulus and rate.
double error_of_work(const RateFactor& rate, const FallingModulus& modulus, int increments) {
    Point<QuadraticYield> at({kappa, mu, voce, two, modulus, {}, rate}, hill());
    const auto energy = [&] {
        const Energy found = at.metal.energy(at.h, at.after.data());
        return found.elastic + found.plastic;
    };
    double work = 0.0, begin = 0.0;
    Voigt before{};
    for (int increment = 0; increment < increments; ++increment) {  // ever faster
        const double size = 8e-3 * (2 * increment + 1) / increments / increments;
        const Voigt change{2.0 * size, -0.5 * size, -1.5 * size, size, 0, 0};
        at.advance(change, 0.1 * time_step / increments);
        if (4 * increment < increments)
            begin = energy();
        else
            for (int p = 0; p < 6; ++p) work += 0.5 * (at.T[p] + before[p]) * change[p];
        before = at.T;
    }
    return (energy() - begin) / work - 1.0;
}

/// It falls with the square of the increments where the modulus is constant. eqs. (3.83), (3.125)
void check_work(const RateFactor& rate) {
    const double coarse = error_of_work(rate, {}, 100), fine = error_of_work(rate, {}, 400);
    CHECK(std::abs(fine) < 0.1 * std::abs(coarse));
    CHECK(std::abs(error_of_work(rate, {0.6, 200}, 400)) < 2e-4);
}

/// Which parts a metal has, one behind the other, and no point needs more than what is set aside for the longest one.
void check_history() {
    const auto names = [](const MetalParts& parts) {
        std::string all;
        for (const auto& [name, size] : MetalHistory(parts).list()) all += name + ' ' + std::to_string(size) + ' ';
        return all;
    };
    const std::string always = "plastic_strain 6 eqps 1 ", work = "kinematic_work 1 ";
    CHECK(names({kappa, mu, voce}) == always);
    CHECK(names({kappa, mu, voce, {}, falling}) == always + work);
    CHECK(names({kappa, mu, voce, {}, {}, {}, johnson_cook}) == always + work + "overstress 1 ");
    CHECK(names({kappa, mu, voce, two}) == always + work + "back_stress_1 6 back_stress_2 6 ");
    const Chaboche four{{{1, 1}, {2, 2}, {3, 3}, {4, 4}}};
    const MetalParts longest{kappa, mu, voce, four, falling, spcc, johnson_cook};
    const MetalHistory table(longest);
    int size = 0;
    for (const HistoryVariable& quantity : table.list()) size += quantity.size;
    CHECK(size == table.size() && size == MetalHistory::largest());
    CHECK(table.back_stress[3] == table.back_stress[0] + 18 && table.inner_back_stress == table.back_stress[3] + 6);
    CHECK(table.stagnation_centre == table.bounding_growth + 1 && table.overstress == table.stagnation_radius + 1);
}

/// Johnson and Cook below the reference rate: no factor.
void check_slow() {
    const MetalParts slow{kappa, mu, voce, {}, {}, {}, {RateFactor::Kind::JohnsonCook, 1e3, 0.5}};
    Point<QuadraticYield> at(slow, hill());
    at.advance({2e-2, -1e-2, -1e-2, 0, 0, 0});
    CHECK_NEAR(at.metal.yield.value(at.stress()) / yield_stress(voce, at.eqps()).value, 1.0, 1e-12);
}

/// Two surfaces in tension, back and on: both back stresses by backward Euler; the bounding surface grows only where its centre lies on
/// the stagnation surface, which it pushes. eqs. (3.94)-(3.98)
template <class Yield>
void check_two_surfaces(const Yield& yield) {
    constexpr double C = 500, B = 168, growth = 190, b = 9, m = 12, share = 0.5, Y = 124;
    Point<Yield> at({kappa, mu, perfect, {{{m * b, m}}}, {}, spcc}, yield);
    const MetalHistory& table = at.metal.table;
    const int beta = table.back_stress[0], inner = table.inner_back_stress, bounding = table.bounding_growth;
    const int centre = table.stagnation_centre, radius = table.stagnation_radius;
    CHECK(radius + 1 == table.size() && table.overstress < 0);
    int grown = 0, stagnant = 0;
    const auto distance = [&](const Deviator<double>& d) { return std::sqrt(1.5 * dot(d, d)); };
    for (int increment = 0; increment < 90; ++increment) {
        const double way = increment < 30 || increment >= 60 ? 1e-3 : -1e-3;
        at.advance({way, -0.45 * way, -0.55 * way, 0.3 * way, 0, 0});
        const double dp = at.dp(), before = at.before[bounding], after = at.after[bounding];
        if (dp == 0.0) continue;
        const auto alpha = at.deviator(at.after, inner), alpha_before = at.deviator(at.before, inner);
        const auto centred = at.deviator(at.after, beta), centred_before = at.deviator(at.before, beta);
        Deviator<double> xi = at.stress(), from, to;
        for (int i = 0; i < 5; ++i) xi[i] -= alpha[i] + centred[i];
        CHECK_NEAR(yield.value(xi) / Y, 1.0, 1e-12);
        const double a = B + before - Y, recall = std::sqrt(a / distance(alpha));
        for (int i = 0; i < 5; ++i) {
            CHECK_NEAR(alpha[i] - alpha_before[i], C * dp * (a / Y * xi[i] - recall * alpha[i]), 1e-8);
            CHECK_NEAR(centred[i] - centred_before[i], m * dp * (b * xi[i] / Y - centred[i]), 1e-9);
            from[i] = centred_before[i] - at.deviator(at.before, centre)[i];
            to[i] = centred[i] - at.deviator(at.before, centre)[i];
        }
        const double r = at.before[radius], start = distance(from), end = distance(to);
        Deviator<double> left;
        for (int i = 0; i < 5; ++i) left[i] = centred[i] - at.deviator(at.after, centre)[i];
        if (end <= r) {
            ++stagnant;
            CHECK_NEAR(after, before, 0.0);
            CHECK_NEAR(at.after[radius], r, 0.0);
        } else {
            ++grown;
            const double outside = m * dp * std::min((end - r) / (end - start), 1.0);
            CHECK_NEAR(after - before, outside * (growth - after), 1e-10);
            CHECK_NEAR(at.after[radius], r + share * (end - r), 1e-10);
            CHECK_NEAR(distance(left), at.after[radius], 1e-9);
            for (int i = 0; i < 5; ++i) CHECK_NEAR(left[i] * end, to[i] * at.after[radius], 1e-8);
        }
        if (increment % 7 == 0) at.check_tangent();
    }
    CHECK(grown > 30);
    CHECK(stagnant > 5);
}

}  // namespace

int main() {
    check_yield_functions();
    check_history();
    for (const RateFactor& rate : {RateFactor{}, johnson_cook, cowper_symonds}) {
        check_chaboche(hill(), rate);
        check_chaboche(aa2090(), rate);
        check_work(rate);
    }
    check_slow();
    check_two_surfaces(QuadraticYield::hill(0.5, 0.5, 0.5, 1.5, 1.5, 1.5));
    check_two_surfaces(aa2090());
    return report("metal");
}
