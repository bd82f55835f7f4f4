// The facets of a contact pair as Python sees them, for any number of nodes and any rule.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "umform/assembly/connectivity.hpp"
#include "umform/assembly/history.hpp"
#include "umform/assembly/target.hpp"
#include "umform/contact/concept.hpp"
#include "umform/contact/found.hpp"
#include "umform/contact/pose.hpp"

namespace umform {

/// The facets of a pair as Python sees them. `evaluate` reads the converged history and writes the trial history; multipliers are
/// the part of it that an outer loop sets between evaluations. Queries after `evaluate` or `locate` refer to the
/// positions that they were given, and to the present multipliers and penalty.
class ContactBlock {
  public:
    explicit ContactBlock(std::shared_ptr<ContactLaw> law) : law_(std::move(law)) {}
    virtual ~ContactBlock() = default;
    virtual const Connectivity& connectivity() const = 0;
    virtual std::size_t dofs() const = 0;  // length of u and f
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    /// Moves the contact points to x = X + u, and measures their gaps to the tool in its present pose.
    virtual void locate(const double* u) = 0;
    /// Shape functions at the contact points, [point][node] of a facet, or [facet][point][node] where facets differ.
    virtual std::vector<double> shape_values() const = 0;

    Pose pose;
    std::string name = "a contact";  // for messages
    bool open = false;               // whether the tool is open: it holds no point, wherever it is
    /// For each point 1 if the next `evaluate` holds it, without friction, wherever it is; empty: none. eq. (4.230)
    std::vector<std::uint8_t> kept;

    const std::shared_ptr<ContactLaw>& law() const { return law_; }
    virtual bool symmetric() const = 0;
    int points() const { return static_cast<int>(area_.size()); }
    virtual int per_facet() const = 0;  // points of each facet
    const std::vector<double>& areas() const { return area_; }

    /// At all contact points, those of far facets too, which are located now.
    virtual std::vector<Vec3> positions() = 0;
    virtual std::vector<double> gaps() = 0;
    virtual std::vector<Vec3> normals() = 0;

    /// Tractions of the tool on the sheet at all points (not multiplied by the area).
    virtual std::vector<Reaction> reactions() = 0;
    /// What is known of the points that are held, as a copy.
    virtual ContactFound found() = 0;
    /// Derivative of sum A t . v with v = w + omega x (x - p) over all points that are held, with respect to u [3 n]: that of the
    /// force, or moment, that a rigid motion of the tool is conjugate to. eq. (4.62)
    virtual std::vector<double> row(const Vec3& w, const Vec3& omega, const Vec3& p) = 0;
    /// Square of what a relative error of all positions makes of the residual, over the square of that error. eq. (5.36)
    virtual double round_off_squared() = 0;
    /// Largest penetration, zero if there is none.
    virtual double penetration() = 0;
    /// Facets that the last `evaluate` or `locate` skipped.
    virtual int far_facets() const = 0;

    const History& history() const { return history_; }
    /// Pressures at zero penetration, zero or more: the present ones, which `commit` makes converged.
    std::vector<double> multipliers() const {
        std::vector<double> values;
        values.reserve(points());
        for (int q = 0; q < points(); ++q) values.push_back(history_.point(q)[ContactHistory::Multiplier]);
        return values;
    }
    void set_multipliers(const double* values) {
        answered_ = false;
        for (int q = 0; q < points(); ++q) history_.point(q)[ContactHistory::Multiplier] = values[q];
    }
    /// Lets multipliers carry tractions [point] along the tool at the points that are held. eq. (4.50)
    virtual void augment(const Vec3* tractions) = 0;
    /// Makes the places where the points are now, by `locate` or `evaluate`, those of a sheet that nothing has held before. It does
    /// nothing once there is a history.
    virtual void begin() = 0;
    bool begun() const { return begun_; }
    /// The history that the last `evaluate` has read, with the multipliers that it was to take: with it it can be repeated.
    std::vector<double> read() const {
        std::vector<double> read = history_.state();
        for (int q = 0; q < points(); ++q) {
            double* row = read.data() + static_cast<std::size_t>(q) * history_.size();
            row[ContactHistory::Multiplier] = history_.point(q)[ContactHistory::Multiplier];
            if (law_->follows_places()) law_->put_wanted(history_.point(q), row);
        }
        return read;
    }
    void commit() {
        begun_ = true, answered_ = false;
        if (law_->follows_places())
            for (int q = 0; q < points(); ++q) law_->settle(history_.point(q));
        history_.commit();
    }
    void revert() {
        history_.revert();
        answered_ = false;
    }
    void restore(const double* state, std::size_t count) {
        history_.restore(state, count);
        begun_ = true, answered_ = false;
    }

  protected:
    std::shared_ptr<ContactLaw> law_;
    std::vector<double> area_;  // [facet][point] reference area of a contact point
    History history_;           // [facet][point]
    bool begun_ = false;        // whether there is a history
    bool answered_ = false;     // whether history and positions are those of the last `evaluate`
};

}  // namespace umform
