// SPDX-License-Identifier: MIT
// Reads the tables of a patch one section at a time. Private to the patch files. [control]
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/document.h"
#include "knotwave/engine/bank.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

/// The files around a patch: where names are looked up, what was read, who names whom.
class FileShelf {
 public:
  /// Reads from the disk.
  FileShelf() = default;
  /// Reads from `texts` alone, which must outlive the shelf.
  explicit FileShelf(std::span<const FileText> texts) : from_texts_(true), given_(texts) {}

  /// The path of `name` as written in the file `from`: beside it unless absolute.
  static std::string beside(const std::string& from, const std::string& name);
  /// One spelling for one file.
  std::string canonical(const std::string& path) const;

  /// Text of a file named by the files in chain(); errors have no source (the caller knows the
  /// place of the name): file_not_found, io_failed, file_too_large, cyclic_reference.
  Result<std::string> read(const std::string& path);
  /// The same for the first file of all, which nobody names: its errors are about the file itself.
  Result<std::string> read_first(const std::string& path);
  /// The curves of a file, read once. Errors of its text have its own place.
  Result<const curves::CurveSet*> curves(const std::string& path);

  /// The paths of all files read() was asked for.
  const std::vector<std::string>& paths() const { return paths_; }
  /// Those that were read, with what was in them.
  std::vector<FileText>& texts() { return texts_; }

  /// Keeps a file in the chain of those being read.
  class Link {
   public:
    Link(FileShelf& shelf, const std::string& path) : shelf_(shelf) {
      shelf_.chain_.push_back(shelf.canonical(path));
    }
    ~Link() { shelf_.chain_.pop_back(); }
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

   private:
    FileShelf& shelf_;
  };

 private:
  bool from_texts_ = false;
  std::span<const FileText> given_;
  std::vector<std::string> chain_;
  std::vector<std::string> paths_;
  std::vector<FileText> texts_;
  std::map<std::string, curves::CurveSet> curve_files_;
};

/// The patch a document holds, its kind already known.
Result<PatchSpec> read_patch(const base::Node& root, const std::string& source_name,
                             FileShelf& shelf);

/// A patch while it is read, and what the sections share.
class PatchReader {
 public:
  PatchReader(const base::Node& root, const std::string& source_name, FileShelf& shelf)
      : root_(root), source_(source_name), shelf_(shelf) {
    patch_.source_name = source_name;
  }
  Result<PatchSpec> read();

 private:
  using Node = base::Node;
  using TableReader = base::TableReader;
  enum class Role { function, wave, law };

  void read_top();
  void read_curves();
  void read_tuning(TableReader& top);
  void read_oscillators();
  void read_oscillator(const Node::Member& member);
  void read_noise();
  void read_envelopes();
  void read_envelope(const Node::Member& member);
  void read_envelope_places(TableReader& reader, EnvelopeUse& use);
  void read_lfos();
  void read_lfo(const Node::Member& member);
  void read_crossfade();
  void read_shaper();
  void read_filter();
  void read_maps();
  void collect_free_numbers(const Node& maps);
  void read_map(const Node& table, int number);
  void read_map_sources(TableReader& reader, MapSpec& map);
  void read_map_target(TableReader& reader, MapSpec& map);
  void read_curve_target(TableReader& reader, const Node& at, MapSpec& map);
  void check_control_conflict(TableReader& reader, const Node& at, const MapSpec& map);
  void check_envelope_name(TableReader& reader, const std::string& name);

  // The curve a key names, drawn or built in, fit for the role; "" when absent or wrong.
  std::string curve_name(TableReader& reader, std::string_view key, Role role);
  const curves::NurbsCurve* find_curve(const std::string& name);
  void check_role(TableReader& reader, const Node& at, const curves::NurbsCurve& curve, Role role);
  std::vector<std::string_view> curve_words(bool with_surfaces) const;
  // The members of a section that holds named tables, checked for names and number.
  std::vector<const Node::Member*> named_tables(std::string_view section, int most);

  // The first error of all is kept; later sections are then not read.
  void keep(const Result<void>& result) {
    if (!error_ && !result) error_ = result.error();
  }
  void fail_at(int line, int column, ErrorCode code, std::string message);
  bool ok() const { return !error_; }

  const Node& root_;
  std::string source_;
  FileShelf& shelf_;
  PatchSpec patch_;
  std::optional<Error> error_;
};

}  // namespace knotwave::engine
