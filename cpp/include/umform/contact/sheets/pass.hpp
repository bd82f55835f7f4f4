// One face against another that deforms as well, as Python sees it.
#pragma once

#include <array>
#include <string>

#include "umform/assembly/history.hpp"
#include "umform/assembly/loose_part.hpp"
#include "umform/contact/sheets/traction.hpp"

namespace umform {

/// What an evaluation of a pass came across, at all its points: [facet][point].
struct SheetFound {
    std::vector<std::uint8_t> status;       // 1 where the other face holds it, 2 where it slips as well
    std::vector<std::int32_t> facet;        // of the other face, -1: none is near
    std::vector<double> gap, pressure;      // NaN where no facet is near; on the reference area
    std::vector<double> slip;               // way along the other face so far
    std::vector<Vec3> x, normal, traction;  // normals out of the other face; tractions on this one
    double contact_energy = 0.0, stored = 0.0, friction_work = 0.0;  // of this pass
    double penetration = 0.0, round_off_squared = 0.0;
};

/// Numbers of a pass. `share` is the part of the traction that it carries: a half where the other face has a pass of its own.
struct SheetSetting {
    double penalty = 0.0, share = 0.5;
    double deepest = 0.0, highest = 0.0;  // penetration that is still one, gap that is still looked at
    bool augmented = false;               // whether multipliers carry pressure without penetration
    SheetFriction friction;
};

class SheetPass {
  public:
    explicit SheetPass(SheetSetting setting) : setting(std::move(setting)) {}
    virtual ~SheetPass() = default;

    SheetSetting setting;
    std::string name = "a contact of sheets";  // for messages

    virtual std::size_t dofs() const = 0;
    virtual bool symmetric() const = 0;
    virtual int points() const = 0;
    virtual int per_facet() const = 0;
    virtual const std::vector<double>& areas() const = 0;
    /// Facets of this face that are near facets of the other at X + u, within a way of both, and look at each other within a turn of both.
    virtual void search(const double* u, double way, double turn) = 0;
    /// Largest way of a node of both faces, and largest turn of a facet, since the search.
    virtual std::array<double, 2> moved_since_search(const double* u) = 0;
    /// Pairs of nodes that its tangent couples, as the last search found them.
    virtual Connectivity couplings() const = 0;
    virtual Outcome evaluate(const double* u, const Pattern& pattern, const Target& target) = 0;
    /// Of the last `evaluate`.
    virtual SheetFound found() const = 0;

    /// Shape functions [facet, or one for all][point][node] of this face at its points.
    virtual std::vector<double> shape_values() const = 0;
    virtual int nodes() const = 0;

    History& history() { return history_; }
    const History& history() const { return history_; }
    void commit() { history_.commit(), wanted_.clear(); }
    void revert() { history_.revert(), wanted_.clear(); }
    void restore(const double* state, std::size_t count) { history_.restore(state, count), wanted_.clear(); }

    /// Pressure of a point at zero penetration: the converged one, or the one that was set since then.
    double multiplier(int q) const {
        return wanted_.empty()
                   ? history_.state()[static_cast<std::size_t>(history_.size()) * q + SheetHistory::Multiplier]
                   : wanted_[q];
    }
    void set_multipliers(const double* values) { wanted_.assign(values, values + points()); }

  protected:
    History history_;

  private:
    std::vector<double> wanted_;
};

}  // namespace umform
