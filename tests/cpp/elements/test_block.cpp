// Blocks of elements: which element fails and why, whose law has thrown, what a law sees of its points.
#include <string>

#include "check.hpp"
#include "umform/elements/block.hpp"
#include "umform/materials/saint_venant_kirchhoff.hpp"

using namespace umform;

namespace {

constexpr int cells = 6;  // a full batch and a part of one

/// Throws where it is stretched by more than a tenth; answers like SVK elsewhere.
struct Picky {
    static constexpr VariableTable<0> table{};
    void initial(double*) const {}
    LaneMask respond(const Vec<Lanes, 6>& E, const Lanes* state, Vec<Lanes, 6>& S, Mat<Lanes, 6, 6>& CC,
                     Lanes* trial) const {
        if (any(E[0] > 0.1)) throw std::domain_error("stretched too far");
        return SaintVenantKirchhoff{1.0, 1.0}.respond(E, state, S, CC, trial);
    }
    Energy energy(const Voigt&, const double*) const { return {}; }
};

/// Fails unless e_1 lies along y, the element is 2 x 2 and the step is a quarter.
struct Curious {
    static constexpr VariableTable<0> table{};
    void initial(double*) const {}
    LaneMask respond(const Vec<Lanes, 6>& E, const Lanes* state, Vec<Lanes, 6>& S, Mat<Lanes, 6, 6>& CC, Lanes* trial,
                     const Point<Lanes>& point) const {
        SaintVenantKirchhoff{1.0, 1.0}.respond(E, state, S, CC, trial);
        return (abs(point.axes[0][1] - 1.0) < 1e-14) & (abs(point.axes[1][0] + 1.0) < 1e-14)
               & (abs(point.axes[2][2] - 1.0) < 1e-14) & (abs(point.size - 2.0) < 1e-14) & LaneMask(point.step == 0.25);
    }
    Energy energy(const Voigt&, const double*) const { return {}; }
};

/// Cubes of edge 2 that share no node.
struct Row {
    Connectivity part{8, {}};
    std::vector<double> X, u;

    Row() {
        for (int e = 0; e < cells; ++e)
            for (int a = 0; a < 8; ++a) {
                part.ids.push_back(8 * e + a);
                const double r = (a % 4 == 1 || a % 4 == 2) ? 1.0 : -1.0, s = a % 4 < 2 ? -1.0 : 1.0;
                X.insert(X.end(), {3.0 * e + r, s, a < 4 ? -1.0 : 1.0});
            }
        u.assign(X.size(), 0.0);
    }
    /// Multiplies a coordinate of the current place of an element.
    void stretch(int e, int direction, double factor) {
        for (int a = 0; a < 8; ++a) {
            const std::size_t at = 3 * (8 * e + a) + direction;
            u[at] = (factor - 1.0) * (X[at] - (direction == 0 ? 3.0 * e : 0.0));
        }
    }
};

template <class Law>
ShellBlockOf<8> block(const Row& row, Law law, std::vector<double> rolling = {}) {
    return {{}, {2, 2}, gauss(2), std::make_shared<MaterialOf<Law>>(law), row.part, row.X, std::move(rolling)};
}

Outcome evaluate(ShellBlock& block, const Row& row) {
    std::vector<double> f(row.u.size());
    return block.evaluate(row.u.data(), {}, {f.data()});
}

/// What a call says when it throws.
template <class Call>
std::string message(const Call& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

void check_inside_out() {
    for (const int e : {0, 3, 5}) {
        Row row;
        ShellBlockOf<8> elements = block(row, SaintVenantKirchhoff{1.0, 1.0});
        CHECK(evaluate(elements, row).failed == -1);
        row.stretch(e, 2, -1.0);  // a mirror image: E is zero
        const Outcome outcome = evaluate(elements, row);
        CHECK(outcome.failed == e && outcome.failure == Failure::Inverted);
        CHECK(std::isnan(elements.energy(row.u.data()).elastic));
        std::vector<double> K(24 * 24), f(24);
        const std::string what = message([&] { elements.element(e, row.u.data(), K.data(), f.data()); });
        CHECK(what.find("cell " + std::to_string(e) + " is turned inside out") == 0);
        row.stretch(e, 0, -1.0);  // turned by half a turn
        CHECK(evaluate(elements, row).failed == -1);
    }
}

void check_names_of_thrown_errors() {
    for (const int e : {2, 4}) {
        Row row;
        ShellBlockOf<8> elements = block(row, Picky{});
        row.stretch(e, 0, 1.3);
        CHECK(message([&] { evaluate(elements, row); }) == "cell " + std::to_string(e) + ": stretched too far");
        elements.set_numbers({10, 11, 12, 13, 14, 15});
        CHECK(message([&] { evaluate(elements, row); }) == "cell " + std::to_string(10 + e) + ": stretched too far");
    }
}

void check_points() {
    const Row row;
    ShellBlockOf<8> along_x = block(row, Curious{}), along_y = block(row, Curious{}, {0.0, 3.0, 0.1});
    along_x.step = along_y.step = 0.25;
    CHECK(evaluate(along_x, row).failure == Failure::Law);
    CHECK(evaluate(along_y, row).failed == -1);
    along_y.step = 0.5;
    CHECK(evaluate(along_y, row).failed == 0);
}

void check_rolling() {
    const Row row;
    CHECK(throws<std::invalid_argument>([&] { block(row, Picky{}, {0.0, 0.0, 1.0}); }));
    CHECK(throws<std::invalid_argument>([&] { block(row, Picky{}, {1.0, 0.0, 0.0, 1.0, 0.0, 0.0}); }));
    std::vector<double> of_each;
    for (int e = 0; e < cells; ++e) of_each.insert(of_each.end(), {e == 4 ? 0.0 : 1.0, 0.0, e == 4 ? 1.0 : 0.0});
    CHECK(message([&] { block(row, Picky{}, of_each); }).find("cell 4") != std::string::npos);
}

}  // namespace

int main() {
    check_inside_out();
    check_names_of_thrown_errors();
    check_points();
    check_rolling();
    return report("block");
}
