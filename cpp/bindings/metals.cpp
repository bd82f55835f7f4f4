#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/materials/logarithmic_space.hpp"
#include "umform/materials/metal.hpp"
#include "umform/materials/yield/yld2004.hpp"
#include "umform/materials/yield/yld2004_roots.hpp"

using namespace umform;

namespace {

using YieldFunction = std::variant<QuadraticYield, Yld2004<6>, Yld2004<8>, Yld2004<0>, Yld2004Roots>;

/// A metal as the bindings take it, and what is made of its law.
struct MetalCard {
    MetalParts parts;
    YieldFunction yield;

    MetalCard(double kappa, double mu, const Hardening& hardening, const YieldFunction& function,
              const std::vector<std::pair<double, double>>& back_stress, double first, double growth, double fall,
              double rate, const std::vector<double>& surfaces, const RateFactor& rate_factor)
        : parts{kappa, mu, hardening, {{}, first, growth}, {fall, rate}}, yield(function) {
        if (back_stress.size() > Chaboche::largest) throw std::invalid_argument("no more than four back stresses");
        for (const auto& [modulus, recall] : back_stress) parts.back_stress.parts.push_back({modulus, recall});
        if (surfaces.size() == 6) {
            parts.two_surfaces = {surfaces[1], surfaces[2], surfaces[3], surfaces[4], surfaces[5], surfaces[0]};
        } else if (!surfaces.empty()) {
            throw std::invalid_argument("two surfaces have the numbers Y, C, B, Rsat, m, h");
        }
        parts.rate = rate_factor;
    }

    std::shared_ptr<Material> law() const {
        return std::visit(
            [&](const auto& function) -> std::shared_ptr<Material> {
                using Law = Metal<std::decay_t<decltype(function)>>;
                return std::make_shared<MaterialOf<Law>>(Law(parts, function));
            },
            yield);
    }

    std::vector<double> residuals(const Input& strain, const Input& state, double step) const {
        Voigt h;
        if (strain.size() != h.size()) throw std::invalid_argument("a strain has six components");
        std::copy_n(strain.data(), h.size(), h.begin());
        return std::visit(
            [&](const auto& function) {
                const Metal law(parts, function);
                if (state.size() != static_cast<std::size_t>(law.table.size()))
                    throw std::invalid_argument("the state is not one of this metal");
                return law.residuals(h, state.data(), step);
            },
            yield);
    }
};

/// phi, its gradient (6,) by the components of the stress.
nb::object evaluate(const YieldFunction& yield, const Input& stress) {
    if (stress.size() != 6) throw std::invalid_argument("a stress has six components");
    Vec<Lanes, 6> T;
    std::copy_n(stress.data(), 6, T.begin());
    return std::visit(
        [&](const auto& function) -> nb::object {
            Lanes phi;
            Deviator<Lanes> n;
            function.gradient(function.basis.components(T, 1.0), phi, n);
            std::vector<double> gradient(6);
            std::ranges::transform(function.basis.tensor(n, 0.5), gradient.begin(), [](Lanes x) { return leading(x); });
            return nb::make_tuple(leading(phi), to_numpy(std::move(gradient), {6}));
        },
        yield);
}

}  // namespace

void bind_metals(nb::module_& m) {
    nb::class_<YieldFunction>(m, "YieldFunction",
                              "Equivalent stress as a function of the stress in the axes of the sheet.")
        .def("__call__", &evaluate, nb::arg("stress"),
             nb::sig("def __call__(self, stress: NDArray[float64]) -> tuple[float, NDArray[float64]]"),
             "Equivalent stress, and its gradient as a strain with engineering shears (6,).");
    nb::class_<RateFactor>(m, "RateFactor", "Factor of the yield stress over the rate of the plastic strain.")
        .def(
            "__call__", [](const RateFactor& factor, double rate) { return factor(rate, 1.0).value; }, nb::arg("rate"),
            "The factor at a plastic strain rate.");
    m.def(
        "cowper_symonds",
        [](double reference, double exponent) {
            return RateFactor{RateFactor::Kind::CowperSymonds, reference, 1.0 / exponent};
        },
        nb::arg("reference"), nb::arg("exponent"));
    m.def(
        "johnson_cook",
        [](double reference, double strength) {
            return RateFactor{RateFactor::Kind::JohnsonCook, reference, strength};
        },
        nb::arg("reference"), nb::arg("strength"));
    m.def(
        "hill48",
        [](double F, double G, double H, double L, double M, double N) {
            return YieldFunction(QuadraticYield::hill(F, G, H, L, M, N));
        },
        nb::arg("F"), nb::arg("G"), nb::arg("H"), nb::arg("L"), nb::arg("M"), nb::arg("N"));
    m.def(
        "yld2004",
        [](double exponent, const std::vector<double>& first, const std::vector<double>& second) {
            std::array<double, 9> a, b;
            if (!(exponent >= 2.0 && exponent <= TransformedStress<double>::most))
                throw std::invalid_argument("the exponent must be from 2 to 20");
            if (first.size() != 9 || second.size() != 9) throw std::invalid_argument("nine coefficients each");
            std::copy_n(first.begin(), 9, a.begin());
            std::copy_n(second.begin(), 9, b.begin());
            const int whole = static_cast<int>(exponent);
            if (whole != exponent || whole % 2 != 0) return YieldFunction(Yld2004Roots(exponent, a, b));
            if (whole == 6) return YieldFunction(Yld2004<6>(whole, a, b));
            if (whole == 8) return YieldFunction(Yld2004<8>(whole, a, b));
            return YieldFunction(Yld2004<0>(whole, a, b));
        },
        nb::arg("exponent"), nb::arg("first"), nb::arg("second"),
        "c12, c13, c21, c23, c31, c32 and the shears 12, 23, 13 of both transformations.");
    nb::class_<MetalCard>(m, "MetalCard", "The parts of a metal.")
        .def(
            nb::init<double, double, const Hardening&, const YieldFunction&,
                     const std::vector<std::pair<double, double>>&, double, double, double, double,
                     const std::vector<double>&, const RateFactor&>(),
            nb::arg("kappa"), nb::arg("mu"), nb::arg("hardening"), nb::arg("yield_function"), nb::arg("back_stress"),
            nb::arg("first"), nb::arg("growth"), nb::arg("fall"), nb::arg("rate"),
            nb::arg("surfaces") = std::vector<double>{}, nb::arg("rate_factor") = RateFactor{},
            "Back stresses are pairs (modulus, recall) whose moduli begin at the share `first`; Young's modulus falls by `fall`.")
        .def("law", &MetalCard::law, "The small-strain law.")
        .def("residuals", &MetalCard::residuals, nb::arg("strain"), nb::arg("state"), nb::arg("step"),
             nb::sig(
                 "def residuals(self, strain: NDArray[float64], state: NDArray[float64], step: float) -> list[float]"),
             "Residuals of the return map at a strain (6,), over the stresses, from its start to its end.");
    m.def(
        "logarithmic_space",
        [](std::shared_ptr<Material> law) -> std::shared_ptr<Material> {
            return std::make_shared<LogarithmicSpace>(std::move(law));
        },
        nb::arg("law"), "A small-strain law as one of finite strain: asked with logarithmic strains.");
}
