// What a point remembers, by name: a law states the parts of its history once, and where each one begins follows from that.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace umform {

/// A part of the history of a point, by its name.
struct HistoryVariable {
    std::string name;
    int size;  // numbers
};

/// The same in a table that the compiler knows.
struct VariableRow {
    std::string_view name;
    int size = 1;
};

/// The parts of a history in their order. `table["slip"]` is where the slip begins; a name that is not there does not compile.
template <std::size_t Count>
class VariableTable {
  public:
    constexpr VariableTable() = default;
    template <std::size_t Rows>
        requires(Rows == Count)
    constexpr VariableTable(const VariableRow (&rows)[Rows]) {
        append(rows, 0);
    }

    constexpr int size() const {
        int numbers = 0;
        for (const VariableRow& row : rows_) numbers += row.size;
        return numbers;
    }
    consteval int operator[](std::string_view name) const {
        int place = 0;
        for (const VariableRow& row : rows_) {
            if (row.name == name) return place;
            place += row.size;
        }
        throw std::out_of_range("the history has no variable of this name");
    }
    /// This table and behind it more rows.
    template <std::size_t More>
    constexpr VariableTable<Count + More> then(const VariableRow (&rows)[More]) const {
        VariableTable<Count + More> all;
        all.append(rows_, 0);
        all.append(rows, Count);
        return all;
    }
    std::vector<HistoryVariable> list() const {
        std::vector<HistoryVariable> history_variables;
        history_variables.reserve(Count);
        for (const VariableRow& row : rows_) history_variables.push_back({std::string(row.name), row.size});
        return history_variables;
    }

  private:
    template <std::size_t>
    friend class VariableTable;

    template <class Rows>
    constexpr void append(const Rows& rows, std::size_t at) {
        for (const VariableRow& row : rows) rows_[at++] = row;
    }

    std::array<VariableRow, Count> rows_{};
};

template <std::size_t Rows>
VariableTable(const VariableRow (&)[Rows]) -> VariableTable<Rows>;

}  // namespace umform
