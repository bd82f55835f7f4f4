// What a contact law is to the facets: a place against the tool and its history in, traction and its derivative out.
#pragma once

#include <concepts>
#include <vector>

#include "umform/assembly/history.hpp"
#include "umform/contact/pose.hpp"

namespace umform {

/// A place of a face (a Gauss point or a node) against the tool, in space. A law that knows a slip keeps it in the frame of the
/// tool, where the place is at pose.to_tool(x).
struct Place {
    double gap;  // signed distance, negative in penetration
    const Vec3 &x, &n;
    const Mat3& H;
    const Pose& pose;
};

/// What the tool does to the sheet at a place: a traction on the reference area, in its parts along and across the normal, times
/// a weight.
struct Reaction {
    bool held;        // if not, the rest has no meaning
    bool slipping;    // whether the tangential traction is at its bound
    double pressure;  // along n, positive
    Vec3 tangential;  // across n
    double K[3][3];   // minus the derivative of the traction with respect to x

    Vec3 traction(const Vec3& n) const {
        Vec3 t;
        for (int k = 0; k < 3; ++k) t[k] = pressure * n[k] + tangential[k];
        return t;
    }
};

/// What friction holds and has cost at a place, per area.
struct Rubbing {
    Vec3 elastic_slip{};  // now, in the frame of the tool
    double slip = 0.0;    // distance slid in all
    double stored = 0.0, work = 0.0;
};

/// A law answers at one place. Its history begins with the multiplier of the normal direction. `state` is the converged history,
/// which is never changed; `trial` comes with the multiplier that is wanted now and takes the rest of the new history. `reach` is
/// the largest gap at which the place can be held. `respond` says whether it is held, and writes the reaction then, without `held`
/// and times the weight. A law that is `symmetric` has a symmetric K; what is below its diagonal is not read. One that
/// `follows_places` has more to say: what it remembers of a place that the tool does not hold, or no longer (`leave`), what friction
/// does there (`rubbing`), how its tangential multipliers are set (`augment`), belong to what was read (`put_wanted`), and become
/// those of the new history (`settle`).
template <class L>
concept PlaceLaw =
    requires(const L& law, L& mutable_law, const Place& place, const double* state, double* trial, Reaction& reaction) {
        { L::symmetric } -> std::convertible_to<bool>;
        { L::follows_places } -> std::convertible_to<bool>;
        { L::quantities() } -> std::same_as<std::vector<Quantity>>;
        { mutable_law.penalty } -> std::same_as<double&>;
        { law.stiffness() } -> std::same_as<double>;
        { law.reach(trial) } -> std::same_as<double>;
        { law.respond(place, 1.0, state, trial, reaction) } -> std::same_as<bool>;
    };

/// Places of a facet, arrays [place].
struct Places {
    const double* gap;
    const Vec3 *x, *n;
    const Mat3* H;
    const Pose* pose;
};

/// The law as the facets see it: one virtual call for all places of a facet.
class ContactLaw {
  public:
    virtual ~ContactLaw() = default;
    virtual bool symmetric() const = 0;
    virtual bool follows_places() const = 0;
    virtual std::vector<Quantity> quantities() const = 0;
    /// Pressure per penetration.
    virtual double penalty() const = 0;
    virtual void set_penalty(double value) = 0;
    /// Largest traction per way of a place in any direction.
    virtual double stiffness() const = 0;
    /// Largest gap at which one of `count` places can be held.
    virtual double reach(int count, const double* trial) const = 0;
    /// Reactions at `count` places times their weights, or as they are without weights.
    virtual void respond(int count, const Places& places, const double* weights, const double* state, double* trial,
                         Reaction* reactions) const = 0;
    // Of one place, and of laws that follow places only; z is in the frame of the tool.
    virtual void leave(const Vec3& z, const double* state, double* trial) const = 0;
    virtual Rubbing rubbing(const double* history) const = 0;
    virtual void augment(const Place& place, const Vec3& t, const double* state, double* trial) const = 0;
    virtual void put_wanted(const double* trial, double* read) const = 0;
    virtual void settle(double* trial) const = 0;
};

template <PlaceLaw Law>
class ContactLawOf final : public ContactLaw {
  public:
    explicit ContactLawOf(Law law) : law_(std::move(law)) {
        for (const Quantity& quantity : Law::quantities()) size_ += quantity.size;
    }
    bool symmetric() const override { return Law::symmetric; }
    bool follows_places() const override { return Law::follows_places; }
    std::vector<Quantity> quantities() const override { return Law::quantities(); }
    double penalty() const override { return law_.penalty; }
    void set_penalty(double value) override { law_.penalty = value; }
    double stiffness() const override { return law_.stiffness(); }
    double reach(int count, const double* trial) const override {
        double largest = law_.reach(trial);
        for (int q = 1; q < count; ++q) largest = std::max(largest, law_.reach(trial + q * size_));
        return largest;
    }
    void respond(int count, const Places& places, const double* weights, const double* state, double* trial,
                 Reaction* reactions) const override {
        for (int q = 0; q < count; ++q)
            reactions[q].held =
                law_.respond({places.gap[q], places.x[q], places.n[q], places.H[q], *places.pose},
                             weights == nullptr ? 1.0 : weights[q], state + q * size_, trial + q * size_, reactions[q]);
    }
    void leave(const Vec3& z, const double* state, double* trial) const override {
        if constexpr (Law::follows_places) law_.leave(z, state, trial);
    }
    Rubbing rubbing(const double* history) const override {
        if constexpr (Law::follows_places) return law_.rubbing(history);
        return {};
    }
    void augment(const Place& place, const Vec3& t, const double* state, double* trial) const override {
        if constexpr (Law::follows_places) law_.augment(place, t, state, trial);
    }
    void put_wanted(const double* trial, double* read) const override {
        if constexpr (Law::follows_places) law_.put_wanted(trial, read);
    }
    void settle(double* trial) const override {
        if constexpr (Law::follows_places) law_.settle(trial);
    }

  private:
    Law law_;
    int size_ = 0;
};

}  // namespace umform
