// A facet on a sphere: force and tangent with multipliers, of a law whose tangent is not symmetric, history, what is found.
#include <numeric>
#include <random>

#include "check.hpp"
#include "umform/contact/cells.hpp"
#include "umform/contact/coulomb.hpp"
#include "umform/contact/facet_block.hpp"
#include "umform/contact/penalty.hpp"
#include "umform/surfaces/plane.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

const std::vector<double> X{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// Pressure of a penalty, and a part of it along x: t = p (n + mu e_x). It remembers where the place was in the frame of the tool.
struct Skewed {
    double penalty, mu;

    static constexpr bool symmetric = false, follows_places = false;
    static constexpr VariableTable table = ContactHistory::table.then({{"place", 3}});
    enum { Multiplier = table["multiplier"], Where = table["place"] };
    double stiffness(const double*) const { return penalty; }
    double reach(const double* trial) const { return trial[Multiplier] / penalty; }

    bool respond(const Place& place, const double*, double* trial, Reaction& reaction) const {
        const Vec3 z = place.pose.to_tool(place.x);
        std::copy(z.begin(), z.end(), trial + Where);
        const double g = place.gap - trial[Multiplier] / penalty;
        if (g > 0.0) return false;
        reaction.pressure = -penalty * g;
        reaction.tangential = {-mu * penalty * g, 0.0, 0.0};
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
                reaction.K[k][l] = penalty * ((place.n[k] + (k == 0 ? mu : 0.0)) * place.n[l] + g * place.H(k, l));
        return true;
    }
    void press(const Place& place, double pressure, const double*, double*, Reaction& reaction) const {
        reaction.pressure = pressure;
        reaction.tangential = {mu * pressure, 0.0, 0.0};
        for (int k = 0; k < 3; ++k) {
            reaction.by_pressure[k] = place.n[k] + (k == 0 ? mu : 0.0);
            for (int l = 0; l < 3; ++l) reaction.K[k][l] = -pressure * place.H(k, l);
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
        const double* point = kept.data() + static_cast<std::ptrdiff_t>(q) * Skewed::table.size();
        CHECK_NEAR(point[Skewed::Multiplier], multipliers[q], 0.0);
        CHECK_NEAR(point[Skewed::Where], x[1], 1e-15);
        CHECK_NEAR(point[Skewed::Where + 1], 5.0 - x[0], 1e-15);
        CHECK_NEAR(point[Skewed::Where + 2], x[2], 1e-15);
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

/// Queries after an evaluation are those of the multipliers, the penalty and the tool of now.
void check_present() {
    const auto block = facet();
    const std::vector<double> u = lowered(std::vector<double>(12), 0.02), multipliers{3.0, 0.0, 1.5, 0.2};
    evaluate(*block, u);
    const std::vector<double> gaps = block->gaps();
    const auto check = [&](double penalty, const std::vector<double>& multiplier) {
        const ContactFound found = block->found();
        CHECK(found.points.size() == 4);
        for (int q = 0; q < 4; ++q) CHECK_NEAR(found.pressure[q], multiplier[q] - penalty * gaps[q], 1e-14);
    };
    check(50.0, std::vector<double>(4));
    block->set_multipliers(multipliers.data());
    check(50.0, multipliers);
    evaluate(*block, u);
    block->law()->set_penalty(80.0);
    check(80.0, multipliers);
    evaluate(*block, u);
    block->open = true;
    CHECK(block->found().points.empty());
    block->open = false;
    block->locate(std::vector<double>(12, 1.0).data());
    CHECK(block->found().points.empty());
}

/// After an evaluation the history may go back: what is asked then is the same.
void check_again() {
    auto friction = std::make_shared<CoulombFriction>();
    friction->pressure = {0.0}, friction->mu = {0.3};
    const auto block = facet(std::make_shared<ContactLawOf<Coulomb>>(Coulomb{50.0, 0.4, 0.05, friction}));
    std::vector<double> u = lowered(waved(), 0.02);
    evaluate(*block, u), block->commit();
    for (int a = 0; a < 4; ++a) u[3 * a] += 0.1;
    const std::vector<double> before = block->history().state();
    evaluate(*block, u);
    const ContactFound found = block->found();
    const std::vector<double> row = block->row({1.0, 0.2, 0.3}, {0.1, 0.5, 0.2}, {});
    const auto check = [&] {
        const ContactFound again = block->found();
        CHECK(again.slip == found.slip && again.traction == found.traction && again.force == found.force);
        CHECK(again.friction_work == found.friction_work && again.stored == found.stored);
        CHECK(again.round_off_squared == found.round_off_squared);
        CHECK(block->row({1.0, 0.2, 0.3}, {0.1, 0.5, 0.2}, {}) == row);
    };
    CHECK(found.slip.size() == 4 && found.slip[0] > 0.05 && found.friction_work > 0.0);
    check();
    block->revert();
    check();
    evaluate(*block, u);
    block->restore(before.data(), before.size());
    check();
}

/// The works of a facet on a plane that is pressed down, slides and leaves, whether it is near afterwards, far or let go.
void check_works(bool cells) {
    auto friction = std::make_shared<CoulombFriction>();
    friction->pressure = {0.0}, friction->mu = {0.3};
    auto law = std::make_shared<ContactLawOf<Coulomb>>(Coulomb{50.0, 0.4, 0.05, friction});
    auto tool = std::make_shared<SurfaceOf<Plane>>(Plane{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}});
    const Connectivity part{4, {0, 1, 2, 3}};
    std::unique_ptr<ContactBlock> block;
    if (cells)
        block = std::make_unique<ContactBlockOf<4, OverCells<4>>>(part, X, CellSetting{2}, tool, law);
    else
        block = std::make_unique<ContactBlockOf<4>>(part, X, ContactRule{{2, 2}, false}, tool, law);
    const auto go = [&](double x, double z) {
        const std::vector<double> u{x, 0, z, x, 0, z, x, 0, z, x, 0, z};
        evaluate(*block, u);
        return block->found();
    };
    const std::vector<double> above{0, 0, 0.1, 0, 0, 0.1, 0, 0, 0.1, 0, 0, 0.1};
    block->locate(above.data());
    block->begin();
    go(0.0, -0.1), block->commit();
    go(1.0, -0.1), block->commit();
    const ContactFound held = go(1.0, -0.1);
    const double bound = 1.5, slid = 0.95, stored = 0.5 * bound * 0.05;
    CHECK_NEAR(held.friction_work, bound * slid, 1e-13);
    CHECK_NEAR(held.stored, stored, 1e-13);
    CHECK_NEAR(held.work_above_mean, 0.5 * bound * slid, 1e-13);
    CHECK_NEAR(held.contact_work, cells ? 0.25 : 0.0, 1e-13);
    for (const double z : {0.5, 1e3, 999.0}) {
        const ContactFound left = go(1.2, z);
        CHECK(block->far_facets() == (z == 999.0 ? 1 : 0));  // its distance is known from before
        CHECK_NEAR(left.friction_work, held.friction_work + 0.5 * bound * 0.2 + stored, 1e-13);
        CHECK_NEAR(left.work_above_mean, held.work_above_mean, 1e-13);
        CHECK_NEAR(left.stored, 0.0, 1e-13);
        CHECK_NEAR(left.contact_work, 0.0, 1e-13);
        block->revert();
        CHECK(block->found().friction_work == left.friction_work);
    }
    go(1.2, -0.1);
    block->open = true;  // loads take the place of the tool, and of its works
    const ContactFound let_go = go(1.2, -0.1);
    CHECK_NEAR(let_go.friction_work, held.friction_work, 1e-13);
    CHECK_NEAR(let_go.work_above_mean, held.work_above_mean, 1e-13);
    CHECK_NEAR(let_go.stored, 0.0, 1e-13);
    block->commit();
    block->open = false;
    CHECK_NEAR(go(1.2, -0.1).contact_work, held.contact_work, 1e-13);  // it touches again as for the first time
}

/// Where the tool holds cells they do the work of their nodal forces, and not more where the facet tilts about the mean gap.
void check_work_of_cells(const std::shared_ptr<const Surface>& tool, double allowed) {
    auto law = std::make_shared<ContactLawOf<Penalty>>(Penalty{50.0});
    ContactBlockOf<4, OverCells<4>> block(Connectivity{4, {0, 1, 2, 3}}, X, CellSetting{2}, tool, law);
    std::vector<double> u = lowered(std::vector<double>(12), 0.1);
    Answer before = evaluate(block, u);
    const double first = block.found().contact_work;
    double work = 0.0;
    for (int i = 0; i < 2; ++i) {
        block.commit();
        const std::vector<double> way{0, 0, 0.01, 0, 0, -0.02, 0, 0, -0.03, 0, 0, 0.01};
        for (int j = 0; j < 12; ++j) u[j] += way[j];
        const Answer after = evaluate(block, u);
        for (int j = 0; j < 12; ++j) work += 0.5 * (before.f[j] + after.f[j]) * way[j];
        before = after;
    }
    CHECK(work > 0.01);
    CHECK_NEAR(block.found().contact_work - first, work, allowed);
}

}  // namespace

int main() {
    check_works(false);
    check_works(true);
    check_work_of_cells(std::make_shared<SurfaceOf<Plane>>(Plane{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}), 1e-14);
    check_work_of_cells(std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.5, 0.5, -4.99}, 5.0, false}), 1e-6);
    check_tangent(facet());
    check_tangent(skewed());
    check_product();
    check_refusal();
    check_history();
    check_found();
    check_present();
    check_again();
    check_resultant();
    check_open_gap();
    return report("contact block");
}
