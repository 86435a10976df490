# The examples that are inside programs and plugins, so that an installed one needs no other file. Demo.*
# of the tests fails when a file of examples/ is not in these lists.
set(knotwave_example_banks
  first-light general-midi)
set(knotwave_example_patches
  arc bass bell belltree block brass clap conga cowbell cuica cymbal drawn-lead drive
  first-light-1-lines first-light-2-decay first-light-3-weight first-light-4-surface flute guiro
  hat-closed hat-open jingle keys kick leaning-bell mono-lead morph-pad muted-drum organ pluck reed
  ride scratch shaker snare strings tom vibraslap voice whistle wind zap)
set(knotwave_example_curves
  arc bend crossfades cycles decay drums envelopes glide lfo shapers surfaces velocity waves)
# By plugin (the word before the first dash), in the order of hosts' menus: new ones at the end of theirs.
set(knotwave_example_plugins
  shaper-warm-valve shaper-soft-peaks shaper-loud-and-square shaper-folder shaper-straight-to-fold
  shaper-octave-up shaper-three-bits shaper-own-diode
  crossfade-equal-power crossfade-duck-under-voice crossfade-to-the-beat crossfade-there-and-back
  crossfade-cut crossfade-gallop crossfade-own-law
  curve-trance-gate curve-pump curve-half-gate curve-swell curve-auto-pan
  curve-filter-wobble curve-stepped-filter curve-stutter curve-rising-sweep curve-struck-by-notes
  curve-own-heartbeat)
set(knotwave_example_envelopes
  drum-duck filter-swell four-voltages mpe-pressure pitch-adsr tempo-tremolo)
set(knotwave_example_scores
  bwv846_prelude first-light groove pachelbel_canon petzold_minuet)

# knotwave_embed(SOURCE NAMESPACE HEADER FOLDER...): a source with the files of these folders.
function(knotwave_embed source namespace header)
  set(files "")
  foreach(folder IN LISTS ARGN)
    set(ending toml)
    if(folder STREQUAL "scores")
      set(ending mid)
    endif()
    foreach(name IN LISTS knotwave_example_${folder})
      list(APPEND files ${PROJECT_SOURCE_DIR}/examples/${folder}/${name}.${ending})
    endforeach()
  endforeach()
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DOUT=${source} -DROOT=${PROJECT_SOURCE_DIR}/examples
            -DNAMESPACE=${namespace} -DHEADER=${header} "-DFILES=${files}" -P ${script}
    DEPENDS ${files} ${script}
    COMMENT "Embedding examples" VERBATIM)
endfunction()
