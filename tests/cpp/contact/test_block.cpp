// A facet on a sphere: force and tangent with multipliers, of a law whose tangent is not symmetric, history, what is found.
#include <numeric>
#include <random>

#include "check.hpp"
#include "umform/contact/facet_block.hpp"
#include "umform/contact/penalty.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

const std::vector<double> X{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// Pressure of a penalty, and a part of it along x: t = p (n + mu e_x). It remembers where the place was in the frame of the tool.
struct Skewed {
    double penalty, mu;

    static constexpr bool symmetric = false, follows_places = false;
    static std::vector<Quantity> quantities() { return {{"multiplier", 1}, {"place", 3}}; }
    double stiffness(const double*) const { return penalty; }
    double reach(const double* trial) const { return trial[0] / penalty; }

    bool respond(const Place& place, double weight, const double*, double* trial, Reaction& reaction) const {
        const Vec3 z = place.pose.to_tool(place.x);
        std::copy(z.begin(), z.end(), trial + 1);
        const double g = place.gap - trial[0] / penalty, stiffness = weight * penalty;
        if (g > 0.0) return false;
        reaction.pressure = -stiffness * g;
        reaction.tangential = {-mu * stiffness * g, 0.0, 0.0};
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
                reaction.K[k][l] = stiffness * ((place.n[k] + (k == 0 ? mu : 0.0)) * place.n[l] + g * place.H(k, l));
        return true;
    }
    void press(const Place& place, double pressure, double weight, const double*, double*, Reaction& reaction) const {
        reaction.pressure = weight * pressure;
        reaction.tangential = {mu * weight * pressure, 0.0, 0.0};
        for (int k = 0; k < 3; ++k) {
            reaction.by_pressure[k] = weight * (place.n[k] + (k == 0 ? mu : 0.0));
            for (int l = 0; l < 3; ++l) reaction.K[k][l] = -weight * pressure * place.H(k, l);
        }
    }
};

/// One facet of unit area on a sphere of radius 5 whose top is 0.01 above its middle.
std::unique_ptr<ContactBlock> facet(std::shared_ptr<ContactLaw> law) {
    auto tool = std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.5, 0.5, -4.99}, 5.0, false});
    return std::make_unique<ContactBlockOf<4>>(Connectivity{4, {0, 1, 2, 3}}, X, ContactRule{{2, 2}, false}, tool, law);
}
std::unique_ptr<ContactBlock> facet() { return facet(std::make_shared<ContactLawOf<Penalty>>(Penalty{50.0})); }
std::unique_ptr<ContactBlock> skewed() { return facet(std::make_shared<ContactLawOf<Skewed>>(Skewed{50.0, 0.3})); }

struct Answer {
    std::vector<double> f = std::vector<double>(12), K = std::vector<double>(144);
};

Answer evaluate(ContactBlock& block, const std::vector<double>& u) {
    std::vector<std::int32_t> equation(12);
    std::iota(equation.begin(), equation.end(), 0);
    const Pattern pattern = make_pattern(equation, {&block.connectivity()}, false);
    const Scatter scatter = make_scatter(pattern, block.connectivity());
    Answer answer;
    block.evaluate(u.data(), scatter, {answer.f.data(), answer.K.data()});
    return answer;
}

std::vector<double> waved() {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0.0, 0.01);
    std::vector<double> u(12);
    for (double& value : u) value = normal(random);
    return u;
}

void check_tangent(const std::unique_ptr<ContactBlock>& block) {
    const std::vector<double> u = waved(), multipliers{3.0, 0.0, 1.5, 0.2};
    block->set_multipliers(multipliers.data());
    const Answer at = evaluate(*block, u);
    const double h = 1e-7;
    double skew = 0.0;
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) skew = std::max(skew, std::abs(at.K[12 * i + j] - at.K[12 * j + i]));
    CHECK(block->symmetric() ? skew == 0.0 : skew > 0.1);
    for (int j = 0; j < 12; ++j) {
        std::vector<double> ahead = u, behind = u;
        ahead[j] += h, behind[j] -= h;
        const Answer plus = evaluate(*block, ahead), minus = evaluate(*block, behind);
        for (int i = 0; i < 12; ++i) CHECK_NEAR(at.K[12 * i + j], (plus.f[i] - minus.f[i]) / (2 * h), 1e-5);
    }
}

/// The resultant of the nodal forces is that of the pressures <lambda - penalty g> at the points.
void check_resultant() {
    const auto block = facet();
    const std::vector<double> u = waved(), multipliers{3.0, 0.0, 1.5, 0.2};
    block->set_multipliers(multipliers.data());
    const Answer at = evaluate(*block, u);
    for (int k = 0; k < 3; ++k) {
        double nodes = 0.0, points = 0.0;
        for (int a = 0; a < 4; ++a) nodes += at.f[3 * a + k];
        for (int q = 0; q < block->points(); ++q) {
            const double pressure = std::max(multipliers[q] - 50.0 * block->gaps()[q], 0.0);
            points -= pressure * block->areas()[q] * block->normals()[q][k];
        }
        CHECK_NEAR(nodes, points, 1e-14);
    }
}

/// A multiplier holds a point at an open gap up to multiplier / penalty = 0.02, and no further.
void check_open_gap() {
    const auto block = facet();
    const std::vector<double> none(4, 0.0), multipliers(4, 1.0);
    for (const double lift : {0.005, 0.05}) {
        std::vector<double> u(12);
        for (int a = 0; a < 4; ++a) u[3 * a + 2] = lift;
        block->set_multipliers(none.data());
        CHECK_NEAR(evaluate(*block, u).f[2], 0.0, 0.0);
        CHECK(block->gaps()[0] > 0.0);
        block->set_multipliers(multipliers.data());
        CHECK((evaluate(*block, u).f[2] < 0.0) == (block->gaps()[0] < 0.02));
        CHECK((block->gaps()[0] < 0.02) == (lift < 0.01));
    }
}

std::vector<double> lowered(std::vector<double> u, double way) {
    for (int a = 0; a < 4; ++a) u[3 * a + 2] -= way;
    return u;
}

/// K du goes with K where K is not symmetric either.
void check_product() {
    const auto block = skewed();
    const std::vector<double> u = waved();
    const Answer at = evaluate(*block, u);
    std::vector<std::int32_t> equation(12, -1);
    const Pattern pattern = make_pattern(equation, {&block->connectivity()}, false);
    std::vector<double> f(12), du(12), Kdu(12);
    for (int j = 0; j < 12; ++j) du[j] = 0.1 * j - 0.3;
    block->evaluate(u.data(), make_scatter(pattern, block->connectivity()), {f.data(), nullptr, du.data(), Kdu.data()});
    CHECK(f == at.f);
    for (int i = 0; i < 12; ++i) {
        double sum = 0.0;
        for (int j = 0; j < 12; ++j) sum += at.K[12 * i + j] * du[j];
        CHECK_NEAR(Kdu[i], sum, 1e-12);
    }
}

/// Where the pattern has one triangle only the law is refused, by the name of the contact; its forces are not.
void check_refusal() {
    const auto block = skewed();
    block->name = "contact punch";
    const std::vector<double> u = lowered(std::vector<double>(12), 0.02);
    std::vector<std::int32_t> equation(12);
    std::iota(equation.begin(), equation.end(), 0);
    const Pattern pattern = make_pattern(equation, {&block->connectivity()}, true);
    const Scatter scatter = make_scatter(pattern, block->connectivity());
    std::vector<double> f(12), values(pattern.indices.size());
    try {
        block->evaluate(u.data(), scatter, {f.data(), values.data()});
        CHECK(false);
    } catch (const std::invalid_argument& error) {
        CHECK(std::string(error.what()).find("contact punch") != std::string::npos);
    }
    CHECK(f == std::vector<double>(12));
    block->evaluate(u.data(), scatter, {f.data()});
    CHECK(f[2] < 0.0 && f[0] != 0.0);
}

/// An evaluation writes the trial history and never the converged one; the place is in the frame of the turned tool.
void check_history() {
    const auto block = skewed();
    block->pose.Q = Mat3{{0, -1, 0, 1, 0, 0, 0, 0, 1}};
    block->pose.c = {5.0, 0.0, 0.0};
    const std::vector<double> begun = block->history().state(), u = waved(), multipliers{1.0, 2.0, 3.0, 4.0};
    block->set_multipliers(multipliers.data());
    const Answer once = evaluate(*block, u), again = evaluate(*block, u);
    CHECK(once.f == again.f && once.K == again.K);
    CHECK(block->history().state() == begun);
    block->commit();
    CHECK(block->multipliers() == multipliers);
    const std::vector<double> kept = block->history().state();
    const std::vector<Vec3> places = block->positions();
    for (int q = 0; q < 4; ++q) {
        const Vec3& x = places[q];
        CHECK_NEAR(kept[4 * q], multipliers[q], 0.0);
        CHECK_NEAR(kept[4 * q + 1], x[1], 1e-15);
        CHECK_NEAR(kept[4 * q + 2], 5.0 - x[0], 1e-15);
        CHECK_NEAR(kept[4 * q + 3], x[2], 1e-15);
    }
    const std::vector<double> others(4, 9.0);
    block->set_multipliers(others.data());
    evaluate(*block, std::vector<double>(12, 0.5));
    block->revert();
    CHECK(block->multipliers() == multipliers && block->history().state() == kept);
    block->restore(begun.data(), begun.size());
    CHECK(block->multipliers() == std::vector<double>(4) && block->history().state() == begun);
    CHECK(throws<std::invalid_argument>([&] { block->restore(begun.data(), 3); }));
}

/// What was found belongs to its evaluation, whatever comes after it.
void check_found() {
    const auto block = skewed();
    const std::vector<double> u = lowered(waved(), 0.0014), multipliers{3.0, 0.0, 1.5, 0.2};
    block->set_multipliers(multipliers.data());
    const Answer at = evaluate(*block, u);
    const ContactFound found = block->found();
    const std::vector<double> gaps = block->gaps();
    evaluate(*block, std::vector<double>(12, 1.0));
    CHECK(block->found().points.empty() && block->penetration() == 0.0);
    CHECK(!found.points.empty() && found.points.size() < 4);
    CHECK(found.penetration > 0.0);
    CHECK_NEAR(found.penetration, -*std::min_element(gaps.begin(), gaps.end()), 0.0);
    Vec3 total{};
    for (int a = 0; a < 12; ++a) total[a % 3] += at.f[a];
    for (std::size_t i = 0; i < found.points.size(); ++i) {
        const int q = found.points[i];
        const double pressure = multipliers[q] - 50.0 * gaps[q];
        CHECK(found.active[q] == 1 && pressure >= 0.0);
        CHECK_NEAR(found.gap[i], gaps[q], 0.0);
        CHECK_NEAR(found.pressure[i], pressure, 1e-14);
        for (int k = 0; k < 3; ++k) {
            const double traction = pressure * (found.normal[i][k] + (k == 0 ? 0.3 : 0.0));
            CHECK_NEAR(found.traction[i][k], traction, 1e-14);
            CHECK_NEAR(found.force[i][k], -traction * found.area[i], 1e-14);
            total[k] -= found.force[i][k];
        }
    }
    for (int k = 0; k < 3; ++k) CHECK_NEAR(total[k], 0.0, 1e-14);
}

}  // namespace

int main() {
    check_tangent(facet());
    check_tangent(skewed());
    check_product();
    check_refusal();
    check_history();
    check_found();
    check_resultant();
    check_open_gap();
    return report("contact block");
}
