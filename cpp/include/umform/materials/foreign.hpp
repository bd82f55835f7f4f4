// Common parts of laws from shared libraries: they may return NaN, and may not be thread-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "umform/materials/function.hpp"

namespace umform {

/// An answer that is refused, and the run with it: what is wrong, the law, and where.
struct RefusedAnswer final : std::exception {
    std::string law, wrong;
    bool finite;  // else it has a number that is none
    std::int32_t cell;
    int point;

    RefusedAnswer(std::string name, std::string what, bool is_finite, std::int32_t number, int q)
        : law(std::move(name)), wrong(std::move(what)), finite(is_finite), cell(number), point(q) {}
    const char* what() const noexcept override { return wrong.c_str(); }
};

/// What a law from a library is, beside its functions.
struct ForeignTraits {
    std::string name;
    std::vector<double> properties;
    bool parallel = false;  // whether several threads may call it at the same time
    MaterialFromFunction::Traits law;
};

/// Locks the calls of a law that is not thread-safe.
class Gate {
  public:
    explicit Gate(bool open) : mutex_(open ? nullptr : std::make_shared<std::mutex>()) {}
    template <class Work>
    auto pass(const Work& work) const {
        if (!mutex_) return work();
        const std::lock_guard<std::mutex> alone(*mutex_);
        return work();
    }

  private:
    std::shared_ptr<std::mutex> mutex_;
};

inline bool all_finite(const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        if (!std::isfinite(values[i])) return false;
    return true;
}

/// The largest difference of a tangent from its transpose, as a share of its largest entry.
inline double asymmetry(const Voigt66& CC) {
    double largest = 0.0, difference = 0.0;
    for (int p = 0; p < 6; ++p)
        for (int q = 0; q < 6; ++q) {
            largest = std::max(largest, std::abs(CC(p, q)));
            difference = std::max(difference, std::abs(CC(p, q) - CC(q, p)));
        }
    return difference / std::max(largest, 1e-300);
}

/// Throws where a point has a number that is none, or a tangent that is not symmetric where it should be.
inline void require_sound(const ForeignTraits& traits, const FunctionArguments& at, const FunctionAnswer& out) {
    constexpr double round_off = 1e-9;
    const std::size_t size = traits.law.initial.size();
    for (int q = 0; q < at.n; ++q) {
        const char* part = nullptr;
        if (!all_finite(out.trial + size * q, size)) part = "the history";
        if (!all_finite(out.CC[q].a.data(), 36)) part = "the tangent";
        if (!all_finite(out.S[q].data(), 6)) part = "the stress";
        if (part != nullptr)
            throw RefusedAnswer(traits.name, part + std::string(" of a law is not finite"), false, at.cell, q);
        if (traits.law.symmetric && asymmetry(out.CC[q]) > round_off)
            throw RefusedAnswer(traits.name, "the tangent of a law is not symmetric", true, at.cell, q);
    }
}

}  // namespace umform
