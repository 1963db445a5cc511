// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <matio.h>

#include <charconv>
#include <cstring>
#include <memory>
#include <string_view>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/mat_layout.hpp"
#include "storage/readers/table.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

using Matrix = Eigen::MatrixXd;
using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

template <typename T>
void convert(const void* data, Matrix& values) {
  const auto* from = static_cast<const T*>(data);
  for (Eigen::Index i = 0; i < values.size(); ++i) values.data()[i] = static_cast<double>(from[i]);
}

/// The numbers of one page (the first two dimensions) of an array.
Matrix page_of(const matvar_t& array, std::size_t page, const fs::path& file) {
  const auto rows = static_cast<Eigen::Index>(array.dims[0]);
  const auto columns = static_cast<Eigen::Index>(array.dims[1]);
  Matrix values(rows, columns);
  const std::size_t count = array.dims[0] * array.dims[1];
  if (count == 0) return values;
  if (array.data == nullptr || array.nbytes < (page + 1) * count * static_cast<std::size_t>(array.data_size)) {
    throw InputError(file.string() + ": not an intact MATLAB file: an array without its data");
  }
  const void* data = static_cast<const char*>(array.data) + page * count * static_cast<std::size_t>(array.data_size);
  switch (array.class_type) {
    case MAT_C_DOUBLE:
      convert<double>(data, values);
      return values;
    case MAT_C_SINGLE:
      convert<float>(data, values);
      return values;
    case MAT_C_INT8:
      convert<std::int8_t>(data, values);
      return values;
    case MAT_C_UINT8:
      convert<std::uint8_t>(data, values);
      return values;
    case MAT_C_INT16:
      convert<std::int16_t>(data, values);
      return values;
    case MAT_C_UINT16:
      convert<std::uint16_t>(data, values);
      return values;
    case MAT_C_INT32:
      convert<std::int32_t>(data, values);
      return values;
    case MAT_C_UINT32:
      convert<std::uint32_t>(data, values);
      return values;
    case MAT_C_INT64:
      convert<std::int64_t>(data, values);
      return values;
    case MAT_C_UINT64:
      convert<std::uint64_t>(data, values);
      return values;
    default:
      throw InputError(file.string() + ": a cell is not numbers: expected a matrix of numbers in each");
  }
}

/// The recordings of one variable: its cells, or the pages of an array, or all of a matrix; column-major, as stored.
struct Cells {
  std::vector<std::size_t> shape;
  std::vector<Matrix> matrices;
};

Cells read_cells(const fs::path& file, const std::string& name) {
  const std::string bytes = read_file(file);
  check_mat_layout(bytes, name, file);
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> opened(Mat_Open(file.c_str(), MAT_ACC_RDONLY), &Mat_Close);
  if (!opened || Mat_GetVersion(opened.get()) != MAT_FT_MAT5)
    throw InputError(file.string() + ": not a MATLAB v5 file");
  const Variable variable(Mat_VarRead(opened.get(), name.c_str()), &Mat_VarFree);
  if (!variable) throw InputError(file.string() + ": cannot read the variable '" + name + "'");
  Cells cells;
  const auto rank = static_cast<std::size_t>(variable->rank);
  if (variable->class_type != MAT_C_CELL) {
    cells.shape.assign(variable->dims + 2, variable->dims + rank);
    std::size_t pages = 1;
    for (const auto size : cells.shape) pages *= size;
    for (std::size_t i = 0; i < pages; ++i) cells.matrices.push_back(page_of(*variable, i, file));
    return cells;
  }
  cells.shape.assign(variable->dims, variable->dims + rank);
  std::size_t count = 1;
  for (const auto size : cells.shape) count *= size;
  for (std::size_t i = 0; i < count; ++i) {
    const matvar_t* cell = Mat_VarGetCell(variable.get(), static_cast<int>(i));
    if (cell == nullptr || cell->rank != 2) throw InputError(file.string() + ": a cell is not a matrix of numbers");
    cells.matrices.push_back(page_of(*cell, 0, file));
  }
  return cells;
}

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const auto size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "1" : text;
}

/// The shape that the description names; trailing dimensions of one cell need no names.
void require_shape(const Cells& cells, const std::vector<CellLabels>& labels, const fs::path& file) {
  std::vector<std::size_t> expected;
  for (const auto& dimension : labels) expected.push_back(dimension.values.size());
  std::vector<std::size_t> found = cells.shape;
  while (found.size() > expected.size() && found.back() == 1) found.pop_back();
  if (found == expected) return;
  throw_input(file, 0, "number of cells", shape_text(cells.shape), shape_text(expected) + " as in table.cells");
}

std::size_t column_number(const std::string& name, std::size_t columns, const fs::path& file) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size() || number < 1 || number > columns) {
    throw_input(file, 0, "column", name, "a number from 1 to " + std::to_string(columns));
  }
  return number - 1;
}

Table to_table(const Matrix& matrix, const Matrix* time, const fs::path& file, const SourceDescription& source) {
  const auto columns = static_cast<std::size_t>(matrix.cols());
  if (source.table.columns != 0 && columns != source.table.columns) {
    throw_input(file, 0, "number of columns", std::to_string(columns),
                std::to_string(source.table.columns) + " (table.columns)");
  }
  std::vector<Eigen::Index> wanted;
  const auto want = [&](const std::string& name) {
    wanted.push_back(static_cast<Eigen::Index>(column_number(name, columns, file)));
  };
  for (const auto& name : source.time.columns) want(name);
  for (const auto& channel : source.channels) want(channel.column);
  if (time != nullptr && time->size() != matrix.rows()) {
    throw_input(file, 0, "number of times", std::to_string(time->size()),
                std::to_string(matrix.rows()) + ", one per row");
  }
  Table table;
  table.width = time_width(source) + source.channels.size();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    if (time != nullptr) table.values.push_back((*time)(row));
    for (const auto column : wanted) table.values.push_back(matrix(row, column));
  }
  return table;
}

/// Names a cell by its labels: "1_scissors".
void name_part(Table& table, const std::vector<CellLabels>& labels, std::size_t cell) {
  for (const auto& dimension : labels) {
    const std::string& value = dimension.values[cell % dimension.values.size()];
    cell /= dimension.values.size();
    table.facts[dimension.name] = value;
    table.part += (table.part.empty() ? "" : "_") + value;
  }
}

}  // namespace

std::vector<Table> read_matlab_tables(const fs::path& file, const SourceDescription& source) {
  const TableLayout& layout = source.table;
  const Cells cells = read_cells(file, layout.variable);
  require_shape(cells, layout.cells, file);
  Cells times;
  if (!source.time.variable.empty()) {
    const fs::path time_file = source.time.file.empty() ? file : file.parent_path() / source.time.file;
    times = read_cells(time_file, source.time.variable);
    require_shape(times, layout.cells, time_file);
  }
  std::vector<Table> tables;
  for (std::size_t i = 0; i < cells.matrices.size(); ++i) {
    const Matrix* time = times.matrices.empty() ? nullptr : &times.matrices[i];
    const Matrix& matrix = cells.matrices[i];
    tables.push_back(layout.transposed ? to_table(matrix.transpose(), time, file, source)
                                       : to_table(matrix, time, file, source));
    name_part(tables.back(), layout.cells, i);
  }
  return tables;
}

}  // namespace opponens::storage
