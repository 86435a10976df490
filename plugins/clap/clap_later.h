// SPDX-License-Identifier: MIT
// Extensions of CLAP that the headers at hand may be too old for, laid out as the specification has
// them (github.com/free-audio/clap, 1.2): tail, preset-load and preset-discovery.
#pragma once
#include <cstdint>

#include <clap/plugin.h>

namespace knotwave::plugins {

inline constexpr char kClapTail[] = "clap.tail";
inline constexpr std::uint32_t kClapEndlessTail = INT32_MAX;  ///< or more
struct ClapTail {
  std::uint32_t(CLAP_ABI* get)(const clap_plugin*);  ///< samples, any thread
};

/// The second is what it was called before 1.2.
inline constexpr const char* kClapPresetLoad[] = {"clap.preset-load/2", "clap.preset-load.draft/2"};
inline constexpr const char* kClapPresetDiscovery[] = {"clap.preset-discovery-factory/2",
                                                       "clap.preset-discovery-factory/draft-2"};
enum ClapPresetPlace : std::uint32_t { kPresetFile = 0, kPresetInPlugin = 1 };
inline constexpr std::uint32_t kPresetOfFactory = 1;

struct ClapPresetLoad {
  bool(CLAP_ABI* from_location)(const clap_plugin*, std::uint32_t kind, const char* location,
                                const char* key);
};
struct ClapHostPresetLoad {
  void(CLAP_ABI* on_error)(const clap_host*, std::uint32_t kind, const char* location,
                           const char* key, std::int32_t os_error, const char* message);
  void(CLAP_ABI* loaded)(const clap_host*, std::uint32_t kind, const char* location,
                         const char* key);
};

struct ClapUniversalId {
  const char* abi;  ///< "clap"
  const char* id;
};
struct ClapPresetReceiver {
  void* data;
  void(CLAP_ABI* on_error)(const ClapPresetReceiver*, std::int32_t os_error, const char* message);
  /// False: nothing more is wanted.
  bool(CLAP_ABI* begin_preset)(const ClapPresetReceiver*, const char* name, const char* key);
  void(CLAP_ABI* add_plugin_id)(const ClapPresetReceiver*, const ClapUniversalId*);
  void(CLAP_ABI* set_soundpack_id)(const ClapPresetReceiver*, const char* id);
  void(CLAP_ABI* set_flags)(const ClapPresetReceiver*, std::uint32_t flags);
  void(CLAP_ABI* add_creator)(const ClapPresetReceiver*, const char* creator);
  void(CLAP_ABI* set_description)(const ClapPresetReceiver*, const char* description);
  void(CLAP_ABI* set_timestamps)(const ClapPresetReceiver*, std::uint64_t made,
                                 std::uint64_t changed);
  void(CLAP_ABI* add_feature)(const ClapPresetReceiver*, const char* feature);
  void(CLAP_ABI* add_extra_info)(const ClapPresetReceiver*, const char* key, const char* value);
};
struct ClapPresetFileType {
  const char *name, *description, *ending;
};
struct ClapPresetLocation {
  std::uint32_t flags;
  const char* name;
  std::uint32_t kind;
  const char* location;
};
struct ClapPresetIndexer {
  clap_version version;
  const char *name, *vendor, *url, *version_text;
  void* data;
  bool(CLAP_ABI* declare_filetype)(const ClapPresetIndexer*, const ClapPresetFileType*);
  bool(CLAP_ABI* declare_location)(const ClapPresetIndexer*, const ClapPresetLocation*);
  bool(CLAP_ABI* declare_soundpack)(const ClapPresetIndexer*, const void*);
  const void*(CLAP_ABI* get_extension)(const ClapPresetIndexer*, const char* id);
};
struct ClapPresetProviderDescriptor {
  clap_version version;
  const char *id, *name, *vendor;
};
struct ClapPresetProvider {
  const ClapPresetProviderDescriptor* descriptor;
  void* data;
  bool(CLAP_ABI* init)(const ClapPresetProvider*);
  void(CLAP_ABI* destroy)(const ClapPresetProvider*);
  bool(CLAP_ABI* get_metadata)(const ClapPresetProvider*, std::uint32_t kind, const char* location,
                               const ClapPresetReceiver*);
  const void*(CLAP_ABI* get_extension)(const ClapPresetProvider*, const char* id);
};
struct ClapPresetFactory {
  std::uint32_t(CLAP_ABI* count)(const ClapPresetFactory*);
  const ClapPresetProviderDescriptor*(CLAP_ABI* get_descriptor)(const ClapPresetFactory*,
                                                                std::uint32_t index);
  const ClapPresetProvider*(CLAP_ABI* create)(const ClapPresetFactory*, const ClapPresetIndexer*,
                                              const char* id);
};

}  // namespace knotwave::plugins
