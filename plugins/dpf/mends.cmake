# DPF's sources are copied to the build folder and mended there, one exact replacement each, so that a DPF whose
# sources differ stops the configuration instead of being built unmended. docs/decisions/dpf.md tells each fault.
set(dpf_copy ${PROJECT_BINARY_DIR}/dpf/distrho)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_FILE})

# dpf_mend(FILE OLD NEW): OLD is found once in FILE.
function(dpf_mend file old new)
  set(path ${dpf_copy}.new/${file})
  file(READ ${path} text)
  string(FIND "${text}" "${old}" first)
  string(FIND "${text}" "${old}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "${KNOTWAVE_DPF_FOLDER}/distrho/${file} is not that of DPF 1.6 (Debian's dpf-source 1.6+ds), "
      "whose faults plugins/dpf/mends.cmake mends. Take that version (-D KNOTWAVE_DPF_FOLDER=...), or build without "
      "LV2 and VST3 (-D KNOTWAVE_WITH_DPF=OFF). Not found, or more than once:\n${old}")
  endif()
  string(REPLACE "${old}" "${new}" text "${text}")
  file(WRITE ${path} "${text}")
endfunction()

file(REMOVE_RECURSE ${dpf_copy}.new)
file(COPY ${KNOTWAVE_DPF_FOLDER}/distrho/ DESTINATION ${dpf_copy}.new)

# More events in a block than DPF keeps are lost, ends of notes too.
dpf_mend(src/DistrhoPluginInternal.hpp "kMaxMidiEvents = 512" "kMaxMidiEvents = 4096")

# Two threads that make instances share what the next one shall be.
foreach(variable "uint32_t    d_nextBufferSize" "double      d_nextSampleRate" "const char* d_nextBundlePath"
    "bool        d_nextPluginIsDummy" "bool        d_nextPluginIsSelfTest"
    "bool        d_nextCanRequestParameterValueChanges")
  dpf_mend(src/DistrhoPluginInternal.hpp "extern ${variable}" "extern thread_local ${variable}")
  dpf_mend(src/DistrhoPlugin.cpp "\n${variable}" "\nthread_local ${variable}")
endforeach()
dpf_mend(src/DistrhoPluginLV2.cpp "static LV2_Program_Descriptor desc;" "static thread_local LV2_Program_Descriptor desc;")

# LV2: the song's place is a sum of floats whose bar is not counted on, at the block's begin, and unknown without a time
# signature. The adapter hears what the host says where it says it; and the song's running beat, too.
dpf_mend(src/DistrhoPluginLV2.cpp "        LV2_URID timeBarBeat;
" "        LV2_URID timeBarBeat;
        LV2_URID timeBeat;
")
dpf_mend(src/DistrhoPluginLV2.cpp "              timeBarBeat(map(LV2_TIME__barBeat)),
" "              timeBarBeat(map(LV2_TIME__barBeat)),
              timeBeat(map(LV2_TIME__beat)),
")
dpf_mend(src/DistrhoPluginLV2.cpp "                                    fURIDs.timeBarBeat, &barBeat,
" "                                    fURIDs.timeBarBeat, &barBeat,
                                    fURIDs.timeBeat, &beat,
")
dpf_mend(src/DistrhoPluginLV2.cpp "                LV2_Atom* barBeat = nullptr;
" "                LV2_Atom* barBeat = nullptr;
                LV2_Atom* beat = nullptr;
")
dpf_mend(src/DistrhoPluginLV2.cpp "                // need to handle this first as other values depend on it
" "                const auto number = [this](const LV2_Atom* const atom) -> double
                {
                    if (atom == nullptr)
                        return NAN;
                    if (atom->type == fURIDs.atomDouble)
                        return ((const LV2_Atom_Double*)atom)->body;
                    if (atom->type == fURIDs.atomFloat)
                        return ((const LV2_Atom_Float*)atom)->body;
                    if (atom->type == fURIDs.atomInt)
                        return ((const LV2_Atom_Int*)atom)->body;
                    if (atom->type == fURIDs.atomLong)
                        return static_cast<double>(((const LV2_Atom_Long*)atom)->body);
                    return NAN;
                };
                knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).hear_song(
                    {number(bar), number(barBeat), number(beat), number(beatUnit), number(beatsPerBar), number(beatsPerMinute), number(speed)},
                    event->time.frames);
                continue;

                // need to handle this first as other values depend on it
")

# LV2: a state that is refused is told to the host.
dpf_mend(src/DistrhoPluginLV2.cpp "#include \"DistrhoPluginInternal.hpp\"" "#include \"DistrhoPluginInternal.hpp\"\n#include \"dpf_beyond.h\"")
dpf_mend(src/DistrhoPluginLV2.cpp "            setState(key, value);

           #if DISTRHO_PLUGIN_WANT_STATE" "            if (! knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).load(value))
                return LV2_STATE_ERR_UNKNOWN;

           #if DISTRHO_PLUGIN_WANT_STATE")

# LV2: presets' text, the state it belongs to, and an interface of no known kind.
set(export src/DistrhoPluginLV2export.cpp)
dpf_mend(${export} "#include \"DistrhoPluginInternal.hpp\"" "#include \"DistrhoPluginInternal.hpp\"\n#include \"dpf_beyond.h\"")
dpf_mend(${export} "                if (value.length() < 10)
                    presetString += \" \\\"\" + value + \"\\\" ;\\n\";
                else
                    presetString += \"\\n\\\"\\\"\\\"\" + value + \"\\\"\\\"\\\" ;\\n\";"
  "                presetString += \"\\n\\\"\\\"\\\"\";
                presetString += knotwave::plugins::turtle_text(value.buffer()).c_str();
                presetString += \"\\\"\\\"\\\" ;\\n\";")
dpf_mend(${export} "                presetString += \"        <\";

                if (plugin.getStateHints(i) & kStateIsHostReadable)"
  "                presetString += \"        <\";

                if (plugin.getStateHints(j) & kStateIsHostReadable)")
dpf_mend(${export} "        // plugin
        pluginString += \"<\" DISTRHO_PLUGIN_URI \">\\n\";"
  "        pluginString += \"<\" LV2_PROGRAMS__Interface \"> a lv2:ExtensionData .\\n\\n\";
        // plugin
        pluginString += \"<\" DISTRHO_PLUGIN_URI \">\\n\";")

include(${CMAKE_CURRENT_LIST_DIR}/mends_vst3.cmake)

# Files that stay as they are keep their time: nothing is compiled again.
file(GLOB_RECURSE files RELATIVE ${dpf_copy}.new ${dpf_copy}.new/*)
foreach(file IN LISTS files)
  get_filename_component(folder ${dpf_copy}/${file} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  file(COPY_FILE ${dpf_copy}.new/${file} ${dpf_copy}/${file} ONLY_IF_DIFFERENT)
endforeach()
file(REMOVE_RECURSE ${dpf_copy}.new)
