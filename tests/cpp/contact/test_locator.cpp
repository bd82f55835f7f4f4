// Facets that are far from the tool are left out, and nothing that is found changes by that.
#include <numeric>
#include <random>

#include "check.hpp"
#include "umform/contact/facet_block.hpp"
#include "umform/contact/penalty.hpp"
#include "umform/surfaces/placed.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

/// A ball whose gap is multiplied, which is no distance then. It counts the points that it is asked for.
class Scaled final : public Surface {
  public:
    Scaled(double factor, bool says_distance) : factor_(factor), says_distance_(says_distance) {}
    bool is_distance() const override { return says_distance_; }
    bool is_concurrent() const override { return !says_distance_; }
    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        asked += count;
        ++calls;
        ball_.gap(count, x, g, n, H);
        for (int q = 0; q < count; ++q) g[q] *= factor_;
    }
    mutable std::atomic<int> asked{0}, calls{0};

  private:
    double factor_;
    bool says_distance_;
    SurfaceOf<Sphere> ball_{Sphere{{0.0, 0.0, 0.0}, 2.0, false}};
};

struct Sheet {
    Connectivity part{4, {}};
    std::vector<double> X;
};

/// A square of 20 x 20 facets of side 1 about the origin, at z = 2.3.
Sheet sheet() {
    Sheet sheet;
    const int n = 20;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) sheet.X.insert(sheet.X.end(), {i - 0.5 * n, j - 0.5 * n, 2.3});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                sheet.part.ids.push_back((i + di) * (n + 1) + j + dj);
    return sheet;
}

std::unique_ptr<ContactBlock> block(const std::shared_ptr<Surface>& surface) {
    const Sheet s = sheet();
    return std::make_unique<ContactBlockOf<4>>(s.part, s.X, ContactRule{{3, 3}, false}, surface,
                                               std::make_shared<ContactLawOf<Penalty>>(Penalty{50.0}));
}

std::vector<double> forces(ContactBlock& block, const std::vector<double>& u) {
    std::vector<double> f(u.size());
    Scatter none;
    block.evaluate(u.data(), none, {f.data()});
    return f;
}

/// One block leaves facets out and the other does not; sheet and tool go their ways, with multipliers now and then.
void check_same(const std::shared_ptr<Surface>& distance, const std::shared_ptr<Surface>& other) {
    const auto culled = block(distance), whole = block(other);
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> u(culled->dofs()), multipliers(culled->points());
    int left_out = 0, held = 0;
    for (int step = 0; step < 60; ++step) {
        const double amplitude = step % 20 == 19 ? 2.0 : 0.02;
        for (double& value : u) value += amplitude * normal(random);
        if (step % 20 == 0) std::fill(u.begin(), u.end(), 0.0);
        for (double& value : multipliers) value = std::max(0.0, 30.0 * normal(random) - 40.0);
        const double angle = 0.05 * step;
        for (const auto& one : {culled.get(), whole.get()}) {
            one->pose.Q = Mat3{{std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1}};
            one->pose.c = {4.0 * std::sin(angle), 0.0, 0.5 * std::sin(3.0 * angle)};
            if (step % 7 == 3) one->set_multipliers(multipliers.data());
        }
        if (step == 40) culled->law()->set_penalty(5.0), whole->law()->set_penalty(5.0);
        CHECK(forces(*culled, u) == forces(*whole, u));
        left_out += culled->far_facets();
        CHECK(whole->far_facets() == 0);
        CHECK(culled->penetration() == whole->penetration());
        const ContactFound one = culled->found(), all = whole->found();
        CHECK(one.active == all.active && one.gap == all.gap && one.force == all.force && one.x == all.x);
        CHECK(one.round_off_squared == all.round_off_squared);
        held += static_cast<int>(all.points.size());
        if (step % 5 == 4) {  // the rest is located now, at the positions of the evaluation
            for (const auto& one_block : {culled.get(), whole.get()}) one_block->pose.c[2] += 7.0;
            CHECK(culled->gaps() == whole->gaps());
            CHECK(culled->normals() == whole->normals() && culled->positions() == whole->positions());
            CHECK(culled->far_facets() == 0);
        }
    }
    CHECK(left_out > 60 * 400 / 3);
    CHECK(held > 1000);
}

/// A multiplier that comes after an evaluation may hold a point of a facet that was far for it.
void check_reach() {
    const auto surface = std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.0, 0.0, 0.0}, 2.0, false});
    const auto one = block(surface);
    const std::vector<double> u(one->dofs()), large(one->points(), 50.0 * 3.0);
    forces(*one, u);
    forces(*one, u);
    CHECK(one->far_facets() > 350 && one->found().points.empty());
    one->set_multipliers(large.data());
    const auto held = one->found().points.size();
    const auto fresh = block(surface);
    fresh->set_multipliers(large.data());
    forces(*fresh, u);
    CHECK(held > 100 && held == fresh->found().points.size());
    one->revert();
    CHECK(one->found().points.empty());
}

/// A gap that changes faster than its point moves: every point is asked for in each evaluation, with one call if need be.
void check_scaled() {
    for (const bool concurrent : {true, false}) {
        auto surface = std::make_shared<Scaled>(3.0, false);
        std::shared_ptr<Surface> tool = surface;
        if (!concurrent)
            tool = std::make_shared<SurfaceFromFunction>([surface](int count, const double* x, double* g, double* n,
                                                                   double* H) { surface->gap(count, x, g, n, H); });
        CHECK(!tool->is_distance() && tool->is_concurrent() == concurrent);
        const auto one = block(std::make_shared<Placed>(tool, Pose{}.Q, Vec3{}));
        std::vector<double> u(one->dofs());
        for (int step = 1; step <= 4; ++step) {
            for (std::size_t i = 2; i < u.size(); i += 3) u[i] -= 0.15;
            forces(*one, u);
            CHECK(one->far_facets() == 0 && surface->asked == step * one->points());
        }
        if (!concurrent) CHECK(surface->calls == 4);
        CHECK(one->penetration() > 0.0);
    }
}

/// A tool that says it is a distance is asked for what is near only, and once for all of it where it may not be asked in parts.
void check_asked() {
    const auto surface = std::make_shared<Scaled>(1.0, true);
    const auto one = block(surface);
    std::vector<double> u(one->dofs());
    forces(*one, u);
    CHECK(surface->asked == one->points() && surface->calls == 1);
    forces(*one, u);
    CHECK(surface->asked == one->points() && surface->calls == 1);  // nothing has moved, nothing touches
    for (std::size_t i = 2; i < u.size(); i += 3) u[i] = -0.4;
    forces(*one, u);
    CHECK(surface->calls == 2 && surface->asked < one->points() * 5 / 4);
    CHECK(!one->found().points.empty());
}

/// Positions that are not numbers are never far.
void check_not_a_number() {
    const auto one = block(std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.0, 0.0, 0.0}, 2.0, false}));
    std::vector<double> u(one->dofs());
    forces(*one, u);
    u[0] = std::nan("");
    forces(*one, u);
    CHECK(one->far_facets() > 0 && std::isnan(one->gaps()[0]));
    u[0] = 0.0;
    forces(*one, u);
    CHECK(std::abs(one->gaps()[0] - 12.0) < 3.0);
}

/// The same bits for any number of threads.
void check_threads() {
    const auto surface = std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.0, 0.0, 0.6}, 2.0, false});
    const int before = thread_count();
    std::vector<std::vector<double>> found;
    for (const int threads : {1, 2, 5}) {
        thread_count() = threads;
        const auto one = block(surface);
        std::vector<double> u(one->dofs());
        for (int step = 0; step < 5; ++step) {
            for (std::size_t i = 0; i < u.size(); ++i) u[i] += 0.01 * std::sin(3.0 * static_cast<double>(i) + step);
            found.push_back(forces(*one, u));
        }
        found.push_back(one->gaps());
    }
    for (std::size_t i = 6; i < found.size(); ++i) CHECK(found[i] == found[i % 6]);
    thread_count() = before;
}

}  // namespace

int main() {
    const auto ball = std::make_shared<SurfaceOf<Sphere>>(Sphere{{0.0, 0.0, 0.0}, 2.0, false});
    check_same(ball, std::make_shared<Scaled>(1.0, false));
    check_same(std::make_shared<Placed>(ball, Pose{}.Q, Vec3{}), std::make_shared<Scaled>(1.0, false));
    check_reach();
    check_scaled();
    check_asked();
    check_not_a_number();
    check_threads();
    return report("contact locator");
}
