//! Connects the lanes and the parts of the engine with several adders. It does for the axes of a time
//! slot what [`super::super::wiring`] does for one axis.

use super::WideEngine;
use crate::engine::layout::{
    BEAT_LAST, BEAT_PHASE, BEAT_PUT, BEAT_WRITE_PUT, COMMIT_LAST, COUNTS_LOSSES, COUNTS_PULSES,
    POSITION_LOW, PUT_NAMES, PUT_NUMBER, PUT_SLOT, SLOT_OF_FIRST,
};
use crate::primitives::compiled_once;
use crate::primitives::word::bit_cast;
use rust_hdl_core::prelude::*;

compiled_once::logic!(WideEngine<N = 8, K = 6>);

impl<const N: usize, const K: usize> compiled_once::Kernel for WideEngine<N, K> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, waits, mask, going, taken, taken_word, unfed, held, drops, active, rest_1,
            rest_2, meeting
        );
        clock!(
            self,
            clock,
            lane_slots,
            findings,
            lane_seek,
            cut_control,
            output_control,
            pulse_width,
            edge_latch,
            stops,
            resets,
            supervisor
        );

        // The schedule. All wheels count the same ticks.
        self.ends.next = self.lane_slots.beat.val().get_bit(BEAT_LAST);
        self.events.next = self.no_axes.val();
        self.backward.next = self.no_axes.val();
        for k in 0..K {
            self.strobe.next = self.event_wheel[k].strobe.val();
            self.phase_start.next = self.event_wheel[k].phase_start.val();
            self.events.next = self.events.val() | self.event_wheel[k].events.val();
            self.backward.next = self.backward.val() | self.event_wheel[k].backward.val();
            self.axis[k].next = self.lane_slots.axis.val() + self.lane_number[k].val();
            self.axis_next[k].next = self.lane_slots.axis_next.val() + self.lane_number[k].val();
            self.axis_one_hot[k].next =
                self.lane_slots.axis_one_hot.val() << self.lane_number[k].val();
            self.masked[k].next = self.mask.q.val().get_bit(k);
        }

        // The words of the host.
        self.nobody.next = bit_cast::<4, 3>(self.put_axis.val()) >= self.axes.val();
        self.own_lane.next = self.no_lanes.val();
        self.own_full.next = false;
        self.own_room.next = self.no_slot.val();
        for k in 0..K {
            self.is_own[k].next = self.axis[k].val() == self.put_axis.val();
            self.own_bit[k].next = self.no_lanes.val();
            if self.is_own[k].val() {
                self.own_bit[k].next = self.one_lane[k].val();
            }
            self.own_lane.next = self.own_lane.val() | self.own_bit[k].val();
            self.own_full.next =
                self.own_full.val() | (self.is_own[k].val() & self.queue[k].full.val());
            if self.is_own[k].val() {
                self.own_room.next = self.queue[k].room.val();
            }
        }
        self.listens.next =
            self.lane_slots.beat.val().get_bit(BEAT_PUT) & self.own_lane.val().any();
        self.names.next = self.put_word.val().get_bit(PUT_NAMES);
        self.put_ready.next = !self.stops.fault.val()
            & (self.nobody.val()
                | (self.listens.val() & !self.names.val() & !self.own_full.val())
                | (self.ends.val()
                    & self.own_lane.val().any()
                    & self.names.val()
                    & !self.cut_control.checks.val()));
        self.room.next = self.own_room.val();
        self.room_valid.next = self.listens.val();
        self.take.next = self.put_valid.val() & self.put_ready.val() & !self.nobody.val();
        if self.lane_slots.beat.val().get_bit(BEAT_WRITE_PUT) {
            self.taken.d.next = self.no_lanes.val();
        }
        if self.take.val() {
            self.taken.d.next = self.no_lanes.val();
            if (self.put_word.val() != self.commit.val()) & !self.names.val() {
                self.taken.d.next = self.own_lane.val();
            }
        }
        if self.lane_slots.beat.val().get_bit(BEAT_PUT) {
            self.taken_word.d.next = self.put_word.val().get_bits::<3>(PUT_NUMBER);
        }

        // A start, as with one adder.
        self.may_start.next = self.enable.val() & self.supervisor.warm.val();
        self.start_ready.next = self.strobe.val()
            & !self.waits.q.val()
            & !self.stops.fault.val()
            & self.may_start.val();
        self.free.next = !self.stops.fault.val() & !self.stops.finds.val();
        self.decides.next = self.strobe.val() & self.waits.q.val() & self.free.val();
        self.go.next =
            self.decides.val() & !self.unfed.q.val() & !self.held.q.val() & !self.drops.q.val();
        if self.strobe.val() {
            self.going.d.next = self.go.val();
        }
        if self.ends.val() {
            self.mask.d.next = (self.mask.q.val() >> self.by_lanes.val())
                | (self.mask.q.val() << self.to_top.val());
        }
        if self.start_ready.val() & self.start_valid.val() {
            self.waits.d.next = true;
            self.mask.d.next = self.start_mask.val();
        }
        if self.go.val() | (self.decides.val() & self.drops.q.val()) | self.stops.fault.val() {
            self.waits.d.next = false;
        }

        // Collects the results of the time slots of all lanes.
        self.some_unfed.next = false;
        self.some_held.next = false;
        self.some_drop.next = false;
        self.some_active.next = false;
        self.some_meet.next = false;
        self.some_miss.next = false;
        self.misplaced.next = false;
        self.samples.next = false;
        for k in 0..K {
            self.some_unfed.next =
                self.some_unfed.val() | (self.masked[k].val() & self.queue[k].empty.val());
            self.some_held.next =
                self.some_held.val() | (self.masked[k].val() & self.queue[k].goes_on.val());
            self.some_drop.next = self.some_drop.val()
                | (self.masked[k].val() & self.lane_seek.slows.val().get_bit(k));
            self.some_active.next =
                self.some_active.val() | self.queue[k].running.val() | !self.queue[k].empty.val();
            self.some_meet.next = self.some_meet.val() | self.readout[k].meets.val();
            self.some_miss.next = self.some_miss.val() | self.queue[k].misses.val();
            self.misplaced.next = self.misplaced.val() | self.queue[k].misplaced.val();
            self.samples.next = self.samples.val() | self.switches[k].samples.val();
        }
        if self.ends.val() {
            self.unfed.d.next = self.unfed.q.val() | self.some_unfed.val();
            self.held.d.next = self.held.q.val() | self.some_held.val();
            self.drops.d.next = self.drops.q.val() | self.some_drop.val();
            self.active.d.next = self.active.q.val() | self.some_active.val();
            self.meeting.d.next = self.meeting.q.val() | self.some_meet.val();
        }
        if self.strobe.val() {
            self.unfed.d.next = false;
            self.held.d.next = false;
            self.drops.d.next = false;
            self.active.d.next = false;
            self.meeting.d.next = false;
            self.rest_1.d.next = !self.active.q.val();
            self.rest_2.d.next = !self.active.q.val() & self.rest_1.q.val();
        }
        if self.take.val() & !self.names.val() {
            self.rest_1.d.next = false;
            self.rest_2.d.next = false;
        }
        if self.resets.completes.val() {
            self.rest_1.d.next = true;
            self.rest_2.d.next = true;
        }

        // The pins.
        self.all_counts.next = self.no_counts.val();
        self.pins_busy.next = false;
        self.late.next = self.no_axes.val();
        for i in 0..N {
            self.pulser[i].clock.next = self.clock.val();
            self.pulser[i].frozen.next = self.stops.frozen.val();
            self.pulser[i].request.next = self.events.val().get_bit(i) & self.phase_start.val();
            self.pulser[i].request_back.next = self.backward.val().get_bit(i);
            self.pulser[i].has_sign.next = self.events.val().get_bit(i) & self.strobe.val();
            self.pulser[i].sign_back.next = self.backward.val().get_bit(i);
            self.count_place[i].counts.next = self.pulser[i].counts.val();
            self.count_place[i].place.next = self.at_counts[i].val();
            self.all_counts.next = self.all_counts.val() | self.count_place[i].all.val();
            self.late_bit[i].next = self.no_axes.val();
            if self.pulser[i].overruns.val() {
                self.late_bit[i].next = self.one_axis[i].val();
            }
            self.late.next = self.late.val() | self.late_bit[i].val();
            self.pins_busy.next =
                self.pins_busy.val() | self.pulser[i].held_back.val() | self.pulser[i].step.val();
            self.step[i].next = self.pulser[i].step.val();
            self.dir[i].next = self.pulser[i].dir.val();
        }
        self.rests.next = self.rest_2.q.val() & !self.waits.q.val() & !self.pins_busy.val();

        // The lanes.
        self.fresh.next = self.no_slot.val();
        self.live.next = self.no_slot.val();
        self.follows.next = false;
        self.starts.next = false;
        self.interlock.next = false;
        self.some_run.next = false;
        self.too_fast.next = self.no_lanes.val();
        self.limits.next = self.no_lanes.val();
        self.dries.next = self.no_lanes.val();
        self.states.next = self.no_lanes.val();
        self.goes_on.next = self.no_lanes.val();
        for k in 0..K {
            self.queue[k].clock.next = self.clock.val();
            self.queue[k].beat.next = self.lane_slots.beat.val();
            self.queue[k].axis.next = self.axis[k].val();
            self.queue[k].axis_next.next = self.axis_next[k].val();
            self.queue[k].starts.next = self.going.q.val() & self.masked[k].val();
            self.queue[k].halted.next = self.stops.halted.val();
            self.queue[k].ramp.next = self.stops.ramp.val() | self.lane_seek.slows.val().get_bit(k);
            self.queue[k].empties.next =
                self.lane_seek.slows.val().get_bit(k) & !self.queue[k].goes_on.val();
            self.queue[k].clear.next = self.stops.clearing.val();
            self.queue[k].take.next = self.take.val() & self.is_own[k].val();
            self.queue[k].put_word.next = self.put_word.val();
            self.queue[k].put_slot.next = self.put_data.val().get_bits::<5>(PUT_SLOT);
            self.queue[k].checks.next = self.cut_control.checks.val();
            self.queue[k].cuts.next = self.cut_control.cuts.val();
            self.queue[k].closes.next = self.cut_control.closes.val();
            self.queue[k].last.next = self.put_data.val().get_bit(COMMIT_LAST);
            self.queue[k].ended.next = self.adder[k].ended.val();
            self.queue[k].overflow.next = self.adder[k].overflow.val();
            self.queue[k].least.next = self.adder[k].least.val();
            self.queue[k].turned.next = self.adder[k].turned.val();
            self.queue[k].back.next = self.adder[k].back.val();
            self.queue[k].meets.next = self.readout[k].meets.val();
            self.queue[k].next_counts.next = self.step_counts[k].next_counts.val();

            self.lane_counts[k].axis_one_hot.next = self.axis_one_hot[k].val();
            self.lane_counts[k].all.next = self.all_counts.val();
            self.step_counts[k].clock.next = self.clock.val();
            self.step_counts[k].beat.next = self.lane_slots.beat.val();
            self.step_counts[k].running.next = self.queue[k].running.val();
            self.step_counts[k].moves.next = self.queue[k].moves.val();
            self.step_counts[k].crosses.next = self.adder[k].crosses.val();
            self.step_counts[k].back.next = self.adder[k].back.val();
            self.step_counts[k].clear.next = self.stops.clearing.val();
            self.step_counts[k].pulses.next =
                self.lane_counts[k].counts.val().get_bits::<3>(COUNTS_PULSES);
            self.step_counts[k].losses.next =
                self.lane_counts[k].counts.val().get_bits::<3>(COUNTS_LOSSES);
            self.step_counts[k].word.next = self.store[k].word.val().get_bits::<3>(POSITION_LOW);
            self.step_counts[k].counts.next = self.queue[k].counts.val();

            self.adder[k].clock.next = self.clock.val();
            self.adder[k].beat.next = self.lane_slots.beat.val();
            self.adder[k].word.next = self.store[k].word.val();
            self.adder[k].put.next = self.put_data.val();
            self.adder[k].counts.next = self.queue[k].running.val();
            self.adder[k].lost.next = self.step_counts[k].lost.val();
            self.adder[k].up.next = self.step_counts[k].up.val();
            self.adder[k].down.next = self.step_counts[k].down.val();
            self.adder[k].wipe.next = self.stops.clearing.val();
            self.adder[k].forgets.next = self.resets.stage_2.val();

            self.store[k].clock.next = self.clock.val();
            self.store[k].beat.next = self.lane_slots.beat.val();
            self.store[k].axis.next = self.axis[k].val();
            self.store[k].live.next = self.queue[k].live.val();
            self.store[k].fresh.next = self.queue[k].fresh.val();
            self.store[k].running.next = self.queue[k].running.val();
            self.store[k].sound.next = self.queue[k].sound.val();
            self.store[k].moves.next = self.queue[k].moves.val();
            self.store[k].slows.next = self.queue[k].slows.val();
            self.store[k].upward.next = self.queue[k].upward.val();
            self.store[k].steady.next = self.queue[k].steady.val();
            self.store[k].wipe.next = self.stops.clearing.val();
            self.store[k].put.next = self.taken.q.val().get_bit(k);
            self.store[k].put_word.next = self.taken_word.q.val();
            self.store[k].sum.next = self.adder[k].sum.val();

            self.event_wheel[k].clock.next = self.clock.val();
            self.event_wheel[k].time_slot_ends.next = self.ends.val();
            self.event_wheel[k].axis_one_hot.next = (self.lane_slots.axis_one_hot.val()
                << self.to_wheel[k].val())
                | (self.lane_slots.axis_one_hot.val() >> self.from_wheel[k].val());
            self.event_wheel[k].crosses.next =
                self.queue[k].moves.val() & self.adder[k].crosses.val();
            self.event_wheel[k].has_sign.next =
                self.queue[k].moves.val() & !self.adder[k].still.val();
            self.event_wheel[k].back.next = self.adder[k].back.val();
            self.event_wheel[k].phase_known.next = self.lane_slots.beat.val().get_bit(BEAT_PHASE);
            self.event_wheel[k].q.next = self.adder[k].q.val();

            self.readout[k].clock.next = self.clock.val();
            self.readout[k].strobe.next = self.strobe.val();
            self.readout[k].beat.next = self.lane_slots.beat.val();
            self.readout[k].is_last.next = self.lane_slots.is_last.val();
            self.readout[k].snapshot.next = self.snapshot.val();
            self.readout[k].caught.next = self.lane_seek.caught.val().get_bit(k);
            self.readout[k].met.next = self.queue[k].met.val();
            self.readout[k].sweeps.next = self.lane_seek.sweeps.val();
            // A hit in any lane delays a snapshot, as the latch does.
            self.readout[k].comes.next = self.edge_latch.comes.val() | self.meeting.q.val();
            self.readout[k].latches.next = self.edge_latch.latches.val();
            self.readout[k].samples.next = self.switches[k].samples.val();
            self.readout[k].row.next = self.supervisor.row.val();
            self.readout[k].earlier.next = self.switches[k].earlier.val();
            self.readout[k].level.next = self.switches[k].level.val();
            self.readout[k].resetting.next = self.resets.resetting.val();
            self.readout[k].word.next = self.store[k].word.val();
            self.readout[k].live.next = self.queue[k].live.val();
            self.readout[k].running.next = self.queue[k].running.val();
            self.readout[k].room.next = self.queue[k].room.val();
            self.readout[k].on_way.next = self.step_counts[k].on_way.val();
            self.state_valid[k].next = self.readout[k].valid.val();
            self.state_page[k].next = self.readout[k].page.val();
            self.state_axis[k].next = self.axis[k].val();
            self.state_item[k].next = self.readout[k].item.val();
            self.state[k].next = self.readout[k].state.val();
            // That of the last lane is the one of the last axis.
            self.refreshed.next = self.readout[k].refreshed.val();

            self.switches[k].clock.next = self.clock.val();
            self.switches[k].time_slot_ends.next = self.ends.val();
            self.switches[k].axis.next = self.axis[k].val();
            self.switches[k].axis_next.next = self.axis_next[k].val();
            self.switches[k].axis_one_hot.next = self.axis_one_hot[k].val();
            self.switches[k].row.next = self.supervisor.row.val();
            self.switches[k].begins_round.next = self.supervisor.begins_round.val();
            self.switches[k].limit_min.next = self.limit_min.val();
            self.switches[k].limit_max.next = self.limit_max.val();
            self.switches[k].inputs_0.next = self.inputs_0.val();
            self.switches[k].inputs_1.next = self.inputs_1.val();
            self.switches[k].goes.next = self.queue[k].moves.val() & !self.adder[k].still.val();
            self.switches[k].back.next = self.adder[k].back.val();
            self.switches[k].resetting.next = self.resets.resetting.val();

            // What the lanes say to the parts that all of them share, one bit each.
            self.some_run.next = self.some_run.val() | self.queue[k].running.val();
            self.fast_bit[k].next = self.no_lanes.val();
            if self.queue[k].too_fast.val() {
                self.fast_bit[k].next = self.one_lane[k].val();
            }
            self.too_fast.next = self.too_fast.val() | self.fast_bit[k].val();
            self.limit_bit[k].next = self.no_lanes.val();
            if self.switches[k].found.val() & !self.lane_seek.forgives.val().get_bit(k) {
                self.limit_bit[k].next = self.one_lane[k].val();
            }
            self.limits.next = self.limits.val() | self.limit_bit[k].val();
            self.dry_bit[k].next = self.no_lanes.val();
            if self.queue[k].dry.val() {
                self.dry_bit[k].next = self.one_lane[k].val();
            }
            self.dries.next = self.dries.val() | self.dry_bit[k].val();
            self.state_bit[k].next = self.no_lanes.val();
            if self.switches[k].state.val() {
                self.state_bit[k].next = self.one_lane[k].val();
            }
            self.states.next = self.states.val() | self.state_bit[k].val();
            self.going_bit[k].next = self.no_lanes.val();
            if self.queue[k].goes_on.val() {
                self.going_bit[k].next = self.one_lane[k].val();
            }
            self.goes_on.next = self.goes_on.val() | self.going_bit[k].val();

            // Lane 0 has the segments of axis 0, which change outputs, and the interlock.
            if self.is_first[k].val().any() {
                self.fresh.next = self.queue[k].fresh.val();
                self.live.next = self.queue[k].live.val();
                self.follows.next = self.queue[k].advances.val();
                self.starts.next = self.going.q.val() & self.masked[k].val();
                self.interlock.next = self.switches[k].interlock.val();
            }
        }

        // The parts of all lanes.
        self.lane_slots.strobe.next = self.strobe.val();
        self.cut_control.strobe.next = self.strobe.val();
        self.cut_control.beat.next = self.lane_slots.beat.val();
        self.cut_control.request.next = self.cut.val();
        self.cut_control.misses.next = self.some_miss.val();
        self.cut_control.resetting.next = self.resets.resetting.val();
        self.cut_busy.next = self.cut_control.busy.val();
        self.cut_refused.next = self.cut_control.refused.val();

        self.outputs_off.next = self.stops.frozen.val()
            | (self.stops.fault.val() & self.off_at_ramps.val().any())
            | !self.supervisor.enabled.val();
        self.output_control.beat.next = self.lane_slots.beat.val();
        // The word that is accepted in this time slot may be that of another axis than axis 0.
        self.output_control.first.next = self.lane_slots.axis_one_hot.val().get_bit(SLOT_OF_FIRST)
            & (!self.lane_slots.beat.val().get_bit(BEAT_PUT)
                | self.own_lane.val().get_bit(SLOT_OF_FIRST));
        self.output_control.take.next = self.take.val();
        self.output_control.put_word.next = self.put_word.val();
        self.output_control.put_data.next = self.put_data.val();
        self.output_control.fresh.next = self.fresh.val();
        self.output_control.live.next = self.live.val();
        self.output_control.starts.next = self.starts.val();
        self.output_control.follows.next = self.follows.val();
        self.output_control.off.next = self.outputs_off.val();
        self.pulse_width.set.next = self.output_control.sets_duty.val() & self.strobe.val();
        self.pulse_width.duty.next = self.output_control.duty.val();
        self.pulse_width.off.next = self.outputs_off.val();
        self.outputs.next = self.output_control.pins.val();
        self.pwm.next = self.pulse_width.pin.val();

        self.lane_seek.strobe.next = self.strobe.val();
        self.lane_seek.axis.next = self.lane_slots.axis.val();
        self.lane_seek.axis_one_hot.next = self.lane_slots.axis_one_hot.val();
        self.lane_seek.state.next = self.states.val();
        self.lane_seek.goes_on.next = self.goes_on.val();
        self.lane_seek.set_source.next = self.seek_source_valid.val();
        self.lane_seek.source.next = self.seek_source.val();
        self.lane_seek.set.next = self.seek_valid.val();
        self.lane_seek.mask.next = self.seek_mask.val();
        self.lane_seek.time_slot_ends.next = self.ends.val();
        self.lane_seek.row.next = self.supervisor.row.val();
        self.lane_seek.samples.next = self.samples.val();
        self.lane_seek.resetting.next = self.resets.resetting.val();

        self.edge_latch.strobe.next = self.strobe.val();
        self.edge_latch.pin.next = self.latch.val();
        self.edge_latch.arm.next = self.latch_arm.val();
        self.edge_latch.resetting.next = self.resets.resetting.val();

        self.findings.time_slot_ends.next = self.ends.val();
        self.findings.axis_one_hot.next = self.lane_slots.axis_one_hot.val();
        self.findings.runs.next = self.some_run.val();
        self.findings.too_fast.next = self.too_fast.val();
        self.findings.limit.next = self.limits.val();
        self.findings.dry.next = self.dries.val();
        self.stops.strobe.next = self.strobe.val();
        self.stops.time_slot_ends.next = self.findings.tells.val();
        self.stops.axis_one_hot.next = self.findings.culprit.val();
        self.stops.runs.next = self.findings.some_run.val();
        self.stops.too_fast.next = self.findings.is_too_fast.val();
        self.stops.limit.next = self.findings.is_limit.val();
        self.stops.dry.next = self.findings.is_dry.val();
        self.stops.late.next = self.late.val();
        self.stops.pressed.next = self.supervisor.pressed.val();
        self.stops.breaks.next = (((self.put_valid.val() & self.nobody.val())
            | self.broken.val()
            | self.misplaced.val()
            | self.output_control.stray.val())
            & !self.stops.fault.val())
            | (self.decides.val() & self.unfed.q.val() & !self.drops.q.val());
        self.stops.missed.next = self.supervisor.missed.val() & !self.rest_2.q.val();
        self.stops.interlock.next = self.interlock.val();
        self.stops.asked.next = self.stop.val();
        self.stops.clear.next = self.clear.val();
        self.stops.pins_busy.next = self.pins_busy.val();
        self.stops.ending.next = self.resets.ending.val();
        self.stops.stage_2.next = self.resets.stage_2.val();
        self.stops.completes.next = self.resets.completes.val();

        self.resets.strobe.next = self.strobe.val();
        self.resets.reset.next = self.reset.val();
        self.resets.settled.next = self.stops.settles.val();
        self.resets.pins_busy.next = self.pins_busy.val();

        self.supervisor.strobe.next = self.strobe.val();
        self.supervisor.estop.next = self.estop.val();
        self.supervisor.kick.next = self.kick.val();
        self.supervisor.enable.next = self.enable.val();
        self.supervisor.idle.next = self.rests.val();
        self.supervisor.ending.next = self.resets.ending.val();
        self.supervisor.resetting.next = self.resets.resetting.val();
        self.supervisor.restarts_round.next = self.resets.restarts_round.val();

        self.enabled.next = self.supervisor.enabled.val();
        self.idle.next = self.rests.val();
        self.fault.next = self.stops.fault.val();
        self.halted.next = self.stops.halted.val();
        self.resetting.next = self.resets.resetting.val();
        self.cause.next = self.stops.cause.val();
        self.culprits.next = self.stops.culprits.val();
        self.armed.next = self.waits.q.val();
        self.ready.next = self.may_start.val();
        self.seeking.next = self.lane_seek.seeking.val();
        self.hits.next = self.lane_seek.hits.val();
        self.latch_armed.next = self.edge_latch.armed.val();
        self.latch_edges.next = self.edge_latch.edges.val();
        self.started.next = self.go.val();
    }
}
