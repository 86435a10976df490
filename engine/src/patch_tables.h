// SPDX-License-Identifier: MIT
// Reads the tables that patches of sound and of the envelope generator have in common: curves,
// envelopes, LFOs and maps. Private to the patch files. [control]
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
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
  Result<std::string> given_text(const std::string& path) const;
  bool from_texts_ = false;
  std::span<const FileText> given_;
  std::vector<std::string> chain_;
  std::vector<std::string> paths_;
  std::vector<FileText> texts_;
  std::map<std::string, curves::CurveSet> curve_files_;
};

/// A patch while it is read, and what its sections share. Each kind of patch is a reader of its own
/// that adds its sections and says their order.
class PatchTables {
 protected:
  using Node = base::Node;
  using TableReader = base::TableReader;
  enum class Role { function, wave, law };

  PatchTables(const base::Node& root, const std::string& source_name, FileShelf& shelf);
  ~PatchTables() = default;

  /// Keys of the file itself that say how notes are played, and what it is called.
  void read_common(TableReader& top);
  void read_curves();
  void read_envelopes();
  void read_lfos();
  void read_maps();

  // The curve a key names, drawn or built in, fit for the role; "" when absent or wrong.
  std::string curve_name(TableReader& reader, std::string_view key, Role role);
  // The members of a section that holds named tables, checked for names and number.
  std::vector<const Node::Member*> named_tables(std::string_view section, int most);
  // The tables of an array of tables, checked for their number; `what` is one of them.
  std::vector<const Node*> tables_of(std::string_view section, const char* what, int most);
  // Two keys that say the same thing in two ways.
  static void exclude(TableReader& reader, const char* one, const char* other);
  // The places a curve has: parameters, or times of a 2-D one.
  struct Domain {
    double low = 0, high = 1;
  };
  Domain places_of(const std::string& curve) const;

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

 private:
  void read_envelope(const Node::Member& member);
  void read_envelope_places(TableReader& reader, EnvelopeUse& use);
  void read_lfo(const Node::Member& member);
  void collect_free_numbers(const Node& maps);
  void read_map(const Node& table, int number);
  void read_map_sources(TableReader& reader, MapSpec& map);
  void read_map_target(TableReader& reader, MapSpec& map);
  std::string why_no_target(const std::string& word) const;
  void read_curve_target(TableReader& reader, const Node& at, MapSpec& map);
  void check_control_conflict(TableReader& reader, const Node& at, const MapSpec& map);
  const curves::NurbsCurve* find_curve(const std::string& name);
  void check_role(TableReader& reader, const Node& at, const curves::NurbsCurve& curve, Role role);
  std::vector<std::string_view> curve_words(bool with_surfaces) const;
};

}  // namespace knotwave::engine
