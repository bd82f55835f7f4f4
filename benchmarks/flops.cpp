// Floating-point operations of one element: the kernels run with a scalar that counts.
//
// Reads an element, its law and one deformed element from the standard input (benchmarks/kernels.py writes it) and prints
// how many operations strains, law, integration and condensation take. A sum, product, quotient or root counts as one.
#include <iostream>

#include "umform/elements/solid_shell.hpp"
#include "umform/materials/j2.hpp"
#include "umform/materials/saint_venant_kirchhoff.hpp"

namespace umform {

long operations = 0;

struct Counted {
    double value;

    Counted() = default;
    Counted(double number) : value(number) {}
    static Counted one(double result) { return ++operations, result; }
    Counted& operator+=(Counted b) { return *this = one(value + b.value); }
    Counted& operator-=(Counted b) { return *this = one(value - b.value); }
    Counted& operator*=(Counted b) { return *this = one(value * b.value); }
    friend Counted operator+(Counted a, Counted b) { return one(a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return one(a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return one(a.value * b.value); }
    friend Counted operator*(double a, Counted b) { return a == 1.0 ? b : one(a * b.value); }  // as the compiler does
    friend Counted operator/(Counted a, Counted b) { return one(a.value / b.value); }
    friend Counted operator-(Counted a) { return -a.value; }
    friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
    friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
    friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
    friend bool operator>=(Counted a, Counted b) { return a.value >= b.value; }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
};

inline Counted select(bool mask, Counted yes, Counted no) { return mask ? yes : no; }
inline Counted abs(Counted x) { return std::abs(x.value); }
inline Counted sqrt(Counted x) { return Counted::one(std::sqrt(x.value)); }
template <class Function>
Counted each(Counted x, const Function& function) {
    return function(x.value);
}
inline Counted exp(Counted x) {
    operations += 30;  // its series
    return std::exp(x.value);
}
inline Counted pow(Counted x, double exponent) { return std::pow(x.value, exponent); }

std::vector<double> read(int count) {
    std::vector<double> numbers(count);
    for (double& number : numbers) std::cin >> number;
    return numbers;
}
int read_count() { return static_cast<int>(read(1)[0]); }

Technology read_technology() {
    Technology technology;
    for (int rows = read_count(); rows > 0; --rows) {
        const int component = read_count(), at_layer = read_count();
        std::vector<double> r = read(read_count()), s = read(read_count());
        technology.tying.push_back({component, std::move(r), std::move(s), at_layer != 0});
    }
    for (int modes = read_count(); modes > 0; --modes) {
        Mode& mode = technology.modes.emplace_back();
        for (int parts = read_count(); parts > 0; --parts) {
            const std::vector<double> part = read(5);
            mode.push_back({static_cast<int>(part[0]), part[1], static_cast<int>(part[2]), static_cast<int>(part[3]),
                            static_cast<int>(part[4])});
        }
    }
    return technology;
}

template <class Law, int Nodes>
void answer(const Law& law, const SolidShell<Nodes, Counted>& element,
            typename SolidShell<Nodes, Counted>::Workspace& w) {
    std::array<double, std::max(Law::table.size(), 1)> initial{};
    law.initial(initial.data());
    std::array<Counted, std::max(Law::table.size(), 1)> state, trial;
    std::copy(initial.begin(), initial.end(), state.begin());
    for (int q = 0; q < element.points(); ++q) law.respond(w.E[q], state.data(), w.S[q], w.CC[q], trial.data());
}

template <int Nodes>
void count(const Technology& technology) {
    const int surface_points = read_count(), columns = read_count(), layers = read_count();
    std::vector<Rule> rules;
    for (int column = 0; column < columns; ++column) {
        std::vector<double> t = read(layers);
        rules.push_back({std::move(t), read(layers)});
    }
    const SolidShell<Nodes, Counted> element(technology, {surface_points, surface_points}, std::move(rules), true);
    const std::vector<double> law = read(read_count()), X = read(3 * Nodes), u = read(3 * Nodes);
    typename SolidShell<Nodes, Counted>::Nodal local_X, local_u;
    std::copy(X.begin(), X.end(), local_X.begin());
    std::copy(u.begin(), u.end(), local_u.begin());
    auto w = element.workspace();
    const std::vector<Counted> alpha(element.modes(), 0.0);
    const auto part = [before = 0L]() mutable { return operations - std::exchange(before, operations); };
    auto since = part;
    element.strains(local_X, local_u, alpha.data(), nullptr, w);
    const long strains = since();
    if (law.size() == 2)
        answer(SaintVenantKirchhoff{law[0], law[1]}, element, w);
    else
        answer(J2{law[0], law[1], LinearVoce{law[2], law[3], law[2], 0.0}}, element, w);
    const long material = since();
    element.integrate({.tangent = true, .corrected = false}, w);
    const long integration = since();
    element.condense(true, w);
    std::cout << strains << ' ' << material << ' ' << integration << ' ' << since() << '\n';
}

}  // namespace umform

int main() {
    const umform::Technology technology = umform::read_technology();
    if (umform::read_count() == 8)
        umform::count<8>(technology);
    else
        umform::count<18>(technology);
}
