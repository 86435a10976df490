# The mends of VST3 (see mends.cmake).
set(vst3 src/DistrhoPluginVST3.cpp)
dpf_mend(${vst3} "#include \"DistrhoPluginInternal.hpp\"" "#include \"DistrhoPluginInternal.hpp\"\n#include \"dpf_beyond.h\"")

# Bytes of MIDI are rounded, not cut: 1 / 127 * 127 in floats may be below 1. A bend ends at 16383. A note that is on
# is no note off, however soft.
foreach(what noteOff.velocity polyPressure.pressure)
  dpf_mend(${vst3} "(int)(eventStorage.${what} * 127)" "(int)std::lround(eventStorage.${what} * 127)")
endforeach()
dpf_mend(${vst3} "std::max(0, std::min(127, (int)(eventStorage.noteOn.velocity * 127)))"
  "std::max(1, std::min(127, (int)std::lround(eventStorage.noteOn.velocity * 127)))")
foreach(byte 1 2)
  dpf_mend(${vst3} "midi[${byte}] = std::max(0, std::min(127, (int)(normalized * 127)))"
    "midi[${byte}] = std::max(0, std::min(127, (int)std::lround(normalized * 127)))")
endforeach()
foreach(part "& 0x7f" ">> 7")
  dpf_mend(${vst3} "std::max(0, std::min(16384, (int)(normalized * 16384))) ${part}"
    "std::max(0, std::min(16383, (int)std::lround(normalized * 16383))) ${part}")
endforeach()

# Events in between were put in at wrong places. The adapter sorts: they are kept as they come.
dpf_mend(${vst3} "        bool placeSorted(const int32_t sampleOffset) noexcept
        {
            InputEvent* const event = &eventList[numUsed];
" "        bool placeSorted(const int32_t sampleOffset) noexcept
        {
            InputEvent* const event = &eventList[numUsed];
            return ++numUsed == kMaxMidiEvents;
")
dpf_mend(${vst3} "for (const InputEvent* event = firstEvent; event != nullptr; event = event->next)
            {" "for (uint32_t i = 0; i < numUsed; ++i)
            {
                const InputEvent* const event = &eventList[i];")

# Buses but the first were never read, and never written.
foreach(way inputs:Inputs:INPUTS outputs:Outputs:OUTPUTS)
  string(REPLACE ":" ";" way ${way})
  list(GET way 0 name)
  list(GET way 1 Name)
  list(GET way 2 NAME)
  dpf_mend(${vst3} "            if (data->${name} != nullptr)
            {
                for (int32_t j = 0; j < data->${name}->num_channels; ++j)
                {
                    while (!fEnabled${Name}[i] && i < DISTRHO_PLUGIN_NUM_${NAME})
                        ${name}[i++] = fDummyAudioBuffer;

                    DISTRHO_SAFE_ASSERT_INT_BREAK(i < DISTRHO_PLUGIN_NUM_${NAME}, i);
                    ${name}[i++] = data->${name}->channel_buffers_32[j];
                }
            }" "            for (; i < DISTRHO_PLUGIN_NUM_${NAME}; ++i)
            {
                const uint32_t bus = fPlugin.getAudioPort(DISTRHO_IS_${NAME}, i).busId;
                int32_t channel = 0;
                for (int32_t j = 0; j < i; ++j)
                    channel += fPlugin.getAudioPort(DISTRHO_IS_${NAME}, j).busId == bus;
                const bool given = fEnabled${Name}[i] && data->${name} != nullptr
                                && bus < static_cast<uint32_t>(data->num_${name}_of_dpf)
                                && channel < data->${name}[bus].num_channels
                                && data->${name}[bus].channel_buffers_32 != nullptr
                                && data->${name}[bus].channel_buffers_32[channel] != nullptr;
                ${name}[i] = given ? data->${name}[bus].channel_buffers_32[channel] : KNOTWAVE_DUMMY_${NAME};
            }")
  string(REGEX REPLACE "s$" "" single ${name})
  set(path ${dpf_copy}.new/${vst3})
  file(READ ${path} text)
  string(REPLACE "num_${name}_of_dpf" "num_${single}_buses" text "${text}")
  string(REPLACE "DISTRHO_IS_INPUTS" "true" text "${text}")
  string(REPLACE "DISTRHO_IS_OUTPUTS" "false" text "${text}")
  string(REPLACE "KNOTWAVE_DUMMY_INPUTS" "fDummyAudioBuffer" text "${text}")
  string(REPLACE "KNOTWAVE_DUMMY_OUTPUTS" "fDummyAudioBuffer + data->nframes" text "${text}")
  file(WRITE ${path} "${text}")
endforeach()
# What an output that nobody hears is written to is no silent input.
dpf_mend(${vst3} "new float[setup->max_block_size]" "new float[2 * setup->max_block_size]")

# Points of automation count at their sample, also where a block has none.
dpf_mend(${vst3} "        if (data->nframes <= 0)
        {
            updateParametersFromProcessing(data->output_params, 0);
            return V3_OK;
        }" "        readPoints(data->input_params);
        if (data->nframes <= 0)
        {
            knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).flush_points();
            if (data->output_params != nullptr)
                updateParametersFromProcessing(data->output_params, 0);
            return V3_OK;
        }")
dpf_mend(${vst3} "                if (v3_cpp_obj(queue)->get_point_count(queue) <= 0)
                    continue;

                // if there are any parameter changes at frame 0, handle them here
                if (v3_cpp_obj(queue)->get_point(queue, 0, &offset, &normalized) != V3_OK)
                    break;

                if (offset != 0)
                    continue;

                const uint32_t index = rindex - kVst3InternalParameterCount;
                _setNormalizedPluginParameterValue(index, normalized);
" "")
dpf_mend(${vst3} "        // if there are any parameter changes after frame 0, set them here
        if (v3_param_changes** const inparamsptr = data->input_params)
" "        if (v3_param_changes** const inparamsptr = nullptr)
")
dpf_mend(${vst3} "        updateParametersFromProcessing(data->output_params, data->nframes - 1);
        return V3_OK;
    }

    uint32_t getTailSamples() const noexcept
    {
        return 0;
    }
" "        if (data->output_params != nullptr)
            updateParametersFromProcessing(data->output_params, data->nframes - 1);
        return V3_OK;
    }

    void readPoints(v3_param_changes** const changes)
    {
        if (changes == nullptr)
            return;
        for (int32_t i = 0, count = v3_cpp_obj(changes)->get_param_count(changes); i < count; ++i)
        {
            v3_param_value_queue** const queue = v3_cpp_obj(changes)->get_param_data(changes, i);
            if (queue == nullptr)
                continue;
            const v3_param_id rindex = v3_cpp_obj(queue)->get_param_id(queue);
            if (rindex < kVst3InternalParameterCount || rindex >= fVst3ParameterCount)
                continue;
            const uint32_t index = static_cast<uint32_t>(rindex - kVst3InternalParameterCount);
            for (int32_t j = 0, points = v3_cpp_obj(queue)->get_point_count(queue); j < points; ++j)
            {
                int32_t sample = 0;
                double normalized = 0;
                if (v3_cpp_obj(queue)->get_point(queue, j, &sample, &normalized) == V3_OK)
                    fCachedParameterValues[kVst3InternalParameterBaseCount + index] =
                        knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).add_point(index, normalized, sample);
            }
        }
    }

    uint32_t getTailSamples() const noexcept
    {
        const int64_t tail = knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).tail();
        return tail < 0 || tail > 0xFFFFFFFEll ? 0xFFFFFFFFu : static_cast<uint32_t>(tail);
    }
")

# A note or pressure that is given has no number of its own: 0 is one.
foreach(what "NOTE_OFF:note_off" "NOTE_ON:note_on" "POLY_PRESSURE:poly_pressure")
  string(REPLACE ":" ";" what ${what})
  list(GET what 0 type)
  list(GET what 1 field)
  dpf_mend(${vst3} "            event.type = V3_EVENT_${type};
            event.${field}.channel" "            event.type = V3_EVENT_${type};
            event.${field}.note_id = -1;
            event.${field}.channel")
endforeach()

# A bend has more than 128 steps.
dpf_mend(${vst3} "            info->step_count = 127;" "            info->step_count = index % 130 == 129 ? 16383 : 127;")

# The host's place in the song as it is: with digits, before the song's begin, without a time signature. DPF's way to bars
# and beats divides by 0 where a bar is shorter than a quarter note, or the host says 0/0.
dpf_mend(${vst3} "        if (v3_process_context* const ctx = data->ctx)
        {
" "        if (const v3_process_context* const ctx = data->ctx)
        {
            knotwave::plugins::Transport transport;
            transport.is_playing = (ctx->state & V3_PROCESS_CTX_PLAYING) != 0;
            transport.has_position = (ctx->state & V3_PROCESS_CTX_PROJECT_TIME_VALID) != 0;
            if (transport.has_position)
                transport.quarters = ctx->project_time_quarters;
            if (ctx->state & V3_PROCESS_CTX_TEMPO_VALID)
                transport.beats_per_minute = ctx->bpm;
            knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).add_transport(transport, 0);
        }

        if (const v3_process_context* const ctx = nullptr)
        {
")

# The end of the controllers' parameters was counted with them: the first parameter of ours was always told to be at its
# low end, which hosts that ask after loading a state then set (Ardour: silence).
dpf_mend(src/DistrhoPluginVST.hpp "kVst3InternalParameterMidiCC_start + 130*16,
    kVst3InternalParameterCount = kVst3InternalParameterMidiCC_end" "kVst3InternalParameterMidiCC_start + 130*16 - 1,
    kVst3InternalParameterCount = kVst3InternalParameterMidiCC_end + 1")

# Several hosts leave out parameters whose name begins so, as they do with those of JUCE. By another name Ardour takes
# them for knobs, keeps them in its sessions and sends all of them when it opens one: volume 0 on every channel.
dpf_mend(${vst3} "\"MIDI Ch. %d CC %d\", static_cast<uint8_t>(index / 130) + 1, index % 130"
  "\"MIDI CC %u|%u\", index / 130 + 1, index % 130")

# A host reads what it set. What it sets while nothing is processed counts at once, and is saved.
dpf_mend(${vst3} "        _setNormalizedPluginParameterValue(index, normalized);
       #endif

        return V3_OK;
    }

    v3_result setComponentHandler" "        _setNormalizedPluginParameterValue(index, normalized);
       #else
        const uint32_t index = static_cast<uint32_t>(rindex - kVst3InternalParameterCount);
        DISTRHO_SAFE_ASSERT_UINT2_RETURN(index < fParameterCount, index, fParameterCount, V3_INVALID_ARG);
        fCachedParameterValues[kVst3InternalParameterBaseCount + index] = normalizedParameterToPlain(rindex, normalized);
        if (! fPlugin.isActive())
        {
            knotwave::plugins::DpfBeyond& beyond = knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer());
            fCachedParameterValues[kVst3InternalParameterBaseCount + index] = beyond.add_point(index, normalized, 0);
            beyond.flush_points();
        }
       #endif

        return V3_OK;
    }

    v3_result setComponentHandler")

# A state is the plugin's own text and no more: whole or refused, whatever the locale and however it is cut up.
dpf_mend(${vst3} "    v3_result setState(v3_bstream** const stream)
    {
" "    v3_result setState(v3_bstream** const stream)
    {
        std::string text;
        for (char part[4096]; text.size() <= (64u << 20);)
        {
            int32_t read = 0;
            if (v3_cpp_obj(stream)->read(stream, part, sizeof part, &read) != V3_OK || read <= 0)
                break;
            text.append(part, static_cast<std::size_t>(read));
        }
        if (! knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).load(text))
            return V3_FALSE;
        for (uint32_t i=0; i<fParameterCount; ++i)
            fCachedParameterValues[kVst3InternalParameterBaseCount + i] = fPlugin.getParameterValue(i);
        if (fComponentHandler != nullptr)
            v3_cpp_obj(fComponentHandler)->restart_component(fComponentHandler, V3_RESTART_PARAM_VALUES_CHANGED);
        return V3_OK;
    }

    v3_result setStateOfDpf(v3_bstream** const stream)
    {
")
dpf_mend(${vst3} "    v3_result getState(v3_bstream** const stream)
    {
" "    v3_result getState(v3_bstream** const stream)
    {
        std::string text = knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).save();
        for (std::size_t done = 0; done < text.size();)
        {
            int32_t written = 0;
            if (v3_cpp_obj(stream)->write(stream, &text[done], static_cast<int32_t>(text.size() - done), &written) != V3_OK
                || written <= 0)
                return V3_INTERNAL_ERR;
            done += static_cast<std::size_t>(written);
        }
        return V3_OK;
    }

    v3_result getStateOfDpf(v3_bstream** const stream)
    {
")

# Values as text, both ways.
dpf_mend(${vst3} "        for (uint32_t i=0; i < enumValues.count; ++i)
        {
            if (d_isEqual(enumValues.values[i].value, value))
            {" "        strncpy_utf16(output, knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).text(index, normalized).c_str(), 128);
        return V3_OK;

        for (uint32_t i=0; i < enumValues.count; ++i)
        {
            if (d_isEqual(enumValues.values[i].value, value))
            {")
dpf_mend(${vst3} "        const ScopedUTF8String input8(input);

        float value;" "        const ScopedUTF8String input8(input);
        const double read = knotwave::plugins::dpf_beyond(fPlugin.getInstancePointer()).normalized(index, std::string(input8));
        if (! (read >= 0.0 && read <= 1.0))
            return V3_INVALID_ARG;
        *output = read;
        return V3_OK;

        float value;")
