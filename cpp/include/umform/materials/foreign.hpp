// Common parts of laws from shared libraries: they may return NaN, and may not be thread-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "umform/materials/function.hpp"

namespace umform {

/// An answer that is refused, and the run with it: what is wrong, the law, and where.
struct RefusedAnswer final : std::exception {
    enum Kind { NotFinite, Asymmetric, BeyondItsArrays };
    std::string law, wrong;
    Kind kind;
    std::int32_t cell;
    int point;

    RefusedAnswer(std::string name, std::string what, Kind of, std::int32_t number, int q)
        : law(std::move(name)), wrong(std::move(what)), kind(of), cell(number), point(q) {}
    const char* what() const noexcept override { return wrong.c_str(); }
};

/// Numbers that a foreign function may write, between margins that it must not.
class Guarded {
  public:
    double* reset(std::size_t size) {
        size_ = size;
        numbers_.assign(size + 2 * margin, mark);
        std::fill_n(data(), size, 0.0);
        return data();
    }
    double* data() { return numbers_.data() + margin; }
    bool intact() const {
        const auto marked = [](double number) { return number == mark; };
        return std::all_of(numbers_.begin(), numbers_.begin() + margin, marked)
               && std::all_of(numbers_.begin() + static_cast<std::ptrdiff_t>(margin + size_), numbers_.end(), marked);
    }

  private:
    static constexpr std::size_t margin = 64;
    static constexpr double mark = -7.0173e-211;  // that no law writes by chance

    std::vector<double> numbers_;
    std::size_t size_ = 0;
};

/// What a law from a library fills, guarded; one a thread.
struct GuardedAnswer {
    Guarded stress, tangent, state;

    void require_intact(const std::string& law, std::int32_t cell, int point) const {
        const char* beyond = !state.intact()     ? "its state"
                             : !stress.intact()  ? "its stress"
                             : !tangent.intact() ? "its tangent"
                                                 : nullptr;
        if (beyond != nullptr)
            throw RefusedAnswer(law, std::string("a law has written beyond ") + beyond, RefusedAnswer::BeyondItsArrays,
                                cell, point);
    }
    static GuardedAnswer& of_thread() {
        static thread_local GuardedAnswer guarded;
        return guarded;
    }
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
            throw RefusedAnswer(traits.name, part + std::string(" of a law is not finite"), RefusedAnswer::NotFinite,
                                at.cell, q);
        if (traits.law.symmetric && asymmetry(out.CC[q]) > round_off)
            throw RefusedAnswer(traits.name, "the tangent of a law is not symmetric", RefusedAnswer::Asymmetric,
                                at.cell, q);
    }
}

}  // namespace umform
