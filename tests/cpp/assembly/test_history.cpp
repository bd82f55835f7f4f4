// Converged and trial state of points.
#include "check.hpp"
#include "umform/assembly/history.hpp"

using namespace umform;

namespace {

/// Two items of three points with a number and a vector each, which begin at 1 .. 4.
History begun() {
    History history(2, 3, {{"multiplier", 1}, {"slip", 3}});
    history.initialise([](double* point) {
        for (int k = 0; k < 4; ++k) point[k] = k + 1;
    });
    return history;
}

void check_layout() {
    History history = begun();
    CHECK(history.size() == 4 && history.stride() == 12 && history.state().size() == 24);
    CHECK(history.history_variables()[1].name == "slip");
    CHECK(history.state(1) == history.state().data() + 12);
    for (int q = 0; q < 6; ++q)
        for (int k = 0; k < 4; ++k) CHECK_NEAR(history.state()[4 * q + k], k + 1, 0.0);
}

/// A table gives places and list; what is appended follows.
void check_table() {
    constexpr VariableTable first{{{"multiplier"}}};
    constexpr VariableTable table = first.then({{"place", 3}, {"slip"}});
    CHECK(first.size() == 1 && table.size() == 5 && VariableTable<0>{}.size() == 0);
    CHECK(table["multiplier"] == 0 && table["place"] == 1 && table["slip"] == 4);
    const std::vector<HistoryVariable> list = table.list();
    CHECK(list.size() == 3 && list[0].name == "multiplier" && list[1].name == "place" && list[1].size == 3);
    CHECK(list[2].name == "slip" && list[2].size == 1);
}

void check_life() {
    History history = begun();
    history.trial(1)[4] = 7.0;  // second point of the second item
    const std::vector<std::uint8_t> expected{0, 0, 0, 0, 1, 0};
    CHECK(history.changed() == expected);
    CHECK_NEAR(history.state(1)[4], 1.0, 0.0);
    history.revert();
    CHECK(history.changed() == std::vector<std::uint8_t>(6));
    CHECK_NEAR(history.trial(1)[4], 1.0, 0.0);
    history.trial(1)[4] = 7.0;
    history.commit();
    CHECK(history.changed() == std::vector<std::uint8_t>(6));
    CHECK_NEAR(history.state(1)[4], 7.0, 0.0);
    const std::vector<double> stored(24, 2.0);
    history.trial(0)[0] = 9.0;
    history.restore(stored.data(), 24);
    CHECK(history.state() == stored);
    CHECK_NEAR(history.trial(0)[0], 2.0, 0.0);
    CHECK(throws<std::invalid_argument>([&] { history.restore(stored.data(), 23); }));
}

void check_none() {
    History history(5, 4, {{"state", 0}});
    history.initialise([](double*) { CHECK(false); });
    CHECK(history.changed().empty());
    history.commit();
    history.revert();
}

}  // namespace

int main() {
    check_layout();
    check_table();
    check_life();
    check_none();
    return report("history");
}
