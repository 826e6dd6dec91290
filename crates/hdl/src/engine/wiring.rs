//! Connects the parts of the engine, and decides about accepted words, starts, rest and the pins.
//!
//! ```text
//! start_valid  _/^^^^^^^\______________________
//! strobe       _______/^\_____/^\_____/^\______
//! armed        _________/^^^^^^^^^^^^^^^\______   until no axis of the mask runs on or ramps down
//! started      _______________________/^\______
//! going        _________________________/^^^^^   the axes start in their time slots of this tick
//! ```
//!
//! A start is accepted at a strobe. It stays armed until no axis of its mask runs on. An axis of
//! the mask without a waiting segment is a breach of the protocol. An axis of the mask that has hit
//! the source of its seek drops the start, because its queue has been emptied.

use super::Engine;
use super::layout::{
    BEAT_LAST, BEAT_PHASE, BEAT_PUT, BEAT_WRITE_PUT, COMMIT_LAST, COUNTS_LOSSES, COUNTS_PULSES,
    MASK_OF_SLOT, POSITION_LOW, PUT_NAMES, PUT_NUMBER, PUT_SLOT, SLOT_OF_FIRST,
};
use crate::primitives::compiled_once;
use crate::primitives::word::bit_cast;
use rust_hdl_core::prelude::*;

compiled_once::logic!(Engine<N = 8>, latch_bank);

impl<const N: usize> compiled_once::Kernel for Engine<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, waits, mask, going, taken, taken_word, unfed, held, drops, active, rest_1,
            rest_2
        );
        clock!(
            self,
            clock,
            time_slot,
            adder,
            queue,
            step_counts,
            cut_control,
            store,
            event_wheel,
            output_control,
            pulse_width,
            switches,
            seek_control,
            edge_latch,
            stops,
            readout,
            resets,
            supervisor
        );

        self.strobe.next = self.event_wheel.strobe.val();
        self.masked.next = self.mask.q.val().get_bit(MASK_OF_SLOT);

        // The words of the host.
        self.nobody.next = bit_cast::<4, 3>(self.put_axis.val()) >= self.axes.val();
        self.is_own.next = self.time_slot.axis.val() == self.put_axis.val();
        self.listens.next = self.time_slot.beat.val().get_bit(BEAT_PUT) & self.is_own.val();
        self.names.next = self.put_word.val().get_bit(PUT_NAMES);
        self.put_ready.next = !self.stops.fault.val()
            & (self.nobody.val()
                | (self.listens.val() & !self.names.val() & !self.queue.full.val())
                | (self.time_slot.beat.val().get_bit(BEAT_LAST)
                    & self.is_own.val()
                    & self.names.val()
                    & !self.cut_control.checks.val()));
        self.room.next = self.queue.room.val();
        self.room_valid.next = self.listens.val();
        self.take.next = self.put_valid.val() & self.put_ready.val() & !self.nobody.val();
        self.taken.d.next = self.taken.q.val() & !self.time_slot.beat.val().get_bit(BEAT_WRITE_PUT);
        if self.take.val() {
            self.taken.d.next = (self.put_word.val() != self.commit.val()) & !self.names.val();
        }
        if self.time_slot.beat.val().get_bit(BEAT_PUT) {
            self.taken_word.d.next = self.put_word.val().get_bits::<3>(PUT_NUMBER);
        }

        // A start is armed at a strobe. It takes effect at the first later strobe at which every
        // axis of its mask is at rest or comes to rest. Until then an axis of the mask that has hit
        // its source drops it, or else one without a waiting segment triggers the stop `protocol`.
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
        if self.time_slot.beat.val().get_bit(BEAT_LAST) {
            self.mask.d.next =
                (self.mask.q.val() >> self.by_one.val()) | (self.mask.q.val() << self.to_top.val());
        }
        if self.start_ready.val() & self.start_valid.val() {
            self.waits.d.next = true;
            self.mask.d.next = self.start_mask.val();
        }
        if self.go.val() | (self.decides.val() & self.drops.q.val()) | self.stops.fault.val() {
            self.waits.d.next = false;
        }

        // Collects the results of the time slots.
        if self.time_slot.beat.val().get_bit(BEAT_LAST) {
            self.unfed.d.next = self.unfed.q.val() | (self.masked.val() & self.queue.empty.val());
            self.held.d.next = self.held.q.val() | (self.masked.val() & self.queue.goes_on.val());
            self.drops.d.next =
                self.drops.q.val() | (self.masked.val() & self.seek_control.slows.val());
            self.active.d.next =
                self.active.q.val() | self.queue.running.val() | !self.queue.empty.val();
        }
        if self.strobe.val() {
            self.unfed.d.next = false;
            self.held.d.next = false;
            self.drops.d.next = false;
            self.active.d.next = false;
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
        self.counts.next = self.none.val();
        self.pins_busy.next = false;
        self.late.next = self.no_axes.val();
        for i in 0..N {
            self.pulser[i].clock.next = self.clock.val();
            self.pulser[i].frozen.next = self.stops.frozen.val();
            self.pulser[i].request.next =
                self.event_wheel.events.val().get_bit(i) & self.event_wheel.phase_start.val();
            self.pulser[i].request_back.next = self.event_wheel.backward.val().get_bit(i);
            self.pulser[i].has_sign.next =
                self.event_wheel.events.val().get_bit(i) & self.strobe.val();
            self.pulser[i].sign_back.next = self.event_wheel.backward.val().get_bit(i);
            self.counted[i].next = self.none.val();
            if self.time_slot.axis_one_hot.val().get_bit(i) {
                self.counted[i].next = self.pulser[i].counts.val();
            }
            self.counts.next = self.counts.val() | self.counted[i].val();
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

        // The inputs of the parts.
        self.time_slot.strobe.next = self.strobe.val();
        self.queue.beat.next = self.time_slot.beat.val();
        self.queue.axis.next = self.time_slot.axis.val();
        self.queue.axis_next.next = self.time_slot.axis_next.val();
        self.queue.starts.next = self.going.q.val() & self.masked.val();
        self.queue.halted.next = self.stops.halted.val();
        self.queue.ramp.next = self.stops.ramp.val() | self.seek_control.slows.val();
        self.queue.empties.next = self.seek_control.slows.val() & !self.queue.goes_on.val();
        self.queue.clear.next = self.stops.clearing.val();
        self.queue.take.next = self.take.val();
        self.queue.put_word.next = self.put_word.val();
        self.queue.put_slot.next = self.put_data.val().get_bits::<5>(PUT_SLOT);
        self.queue.checks.next = self.cut_control.checks.val();
        self.queue.cuts.next = self.cut_control.cuts.val();
        self.queue.closes.next = self.cut_control.closes.val();
        self.queue.last.next = self.put_data.val().get_bit(COMMIT_LAST);
        self.queue.ended.next = self.adder.ended.val();
        self.queue.overflow.next = self.adder.overflow.val();
        self.queue.least.next = self.adder.least.val();
        self.queue.turned.next = self.adder.turned.val();
        self.queue.back.next = self.adder.back.val();
        self.queue.meets.next = self.readout.meets.val();
        self.queue.next_counts.next = self.step_counts.next_counts.val();

        self.cut_control.strobe.next = self.strobe.val();
        self.cut_control.beat.next = self.time_slot.beat.val();
        self.cut_control.request.next = self.cut.val();
        self.cut_control.misses.next = self.queue.misses.val();
        self.cut_control.resetting.next = self.resets.resetting.val();
        self.cut_busy.next = self.cut_control.busy.val();
        self.cut_refused.next = self.cut_control.refused.val();

        self.step_counts.beat.next = self.time_slot.beat.val();
        self.step_counts.running.next = self.queue.running.val();
        self.step_counts.moves.next = self.queue.moves.val();
        self.step_counts.crosses.next = self.adder.crosses.val();
        self.step_counts.back.next = self.adder.back.val();
        self.step_counts.clear.next = self.stops.clearing.val();
        self.step_counts.pulses.next = self.counts.val().get_bits::<3>(COUNTS_PULSES);
        self.step_counts.losses.next = self.counts.val().get_bits::<3>(COUNTS_LOSSES);
        self.step_counts.word.next = self.store.word.val().get_bits::<3>(POSITION_LOW);
        self.step_counts.counts.next = self.queue.counts.val();

        self.adder.beat.next = self.time_slot.beat.val();
        self.adder.word.next = self.store.word.val();
        self.adder.put.next = self.put_data.val();
        self.adder.counts.next = self.queue.running.val();
        self.adder.lost.next = self.step_counts.lost.val();
        self.adder.up.next = self.step_counts.up.val();
        self.adder.down.next = self.step_counts.down.val();
        self.adder.wipe.next = self.stops.clearing.val();
        self.adder.forgets.next = self.resets.stage_2.val();

        self.store.beat.next = self.time_slot.beat.val();
        self.store.axis.next = self.time_slot.axis.val();
        self.store.live.next = self.queue.live.val();
        self.store.fresh.next = self.queue.fresh.val();
        self.store.running.next = self.queue.running.val();
        self.store.sound.next = self.queue.sound.val();
        self.store.moves.next = self.queue.moves.val();
        self.store.slows.next = self.queue.slows.val();
        self.store.upward.next = self.queue.upward.val();
        self.store.steady.next = self.queue.steady.val();
        self.store.wipe.next = self.stops.clearing.val();
        self.store.put.next = self.taken.q.val();
        self.store.put_word.next = self.taken_word.q.val();
        self.store.sum.next = self.adder.sum.val();

        self.event_wheel.time_slot_ends.next = self.time_slot.beat.val().get_bit(BEAT_LAST);
        self.event_wheel.axis_one_hot.next = self.time_slot.axis_one_hot.val();
        self.event_wheel.crosses.next = self.queue.moves.val() & self.adder.crosses.val();
        self.event_wheel.has_sign.next = self.queue.moves.val() & !self.adder.still.val();
        self.event_wheel.back.next = self.adder.back.val();
        self.event_wheel.phase_known.next = self.time_slot.beat.val().get_bit(BEAT_PHASE);
        self.event_wheel.q.next = self.adder.q.val();

        self.outputs_off.next = self.stops.frozen.val()
            | (self.stops.fault.val() & self.off_at_ramps.val().any())
            | !self.supervisor.enabled.val();
        self.output_control.beat.next = self.time_slot.beat.val();
        self.output_control.first.next = self.time_slot.axis_one_hot.val().get_bit(SLOT_OF_FIRST);
        self.output_control.take.next = self.take.val();
        self.output_control.put_word.next = self.put_word.val();
        self.output_control.put_data.next = self.put_data.val();
        self.output_control.fresh.next = self.queue.fresh.val();
        self.output_control.live.next = self.queue.live.val();
        self.output_control.starts.next = self.going.q.val() & self.masked.val();
        self.output_control.follows.next = self.queue.advances.val();
        self.output_control.off.next = self.outputs_off.val();
        self.pulse_width.set.next = self.output_control.sets_duty.val() & self.strobe.val();
        self.pulse_width.duty.next = self.output_control.duty.val();
        self.pulse_width.off.next = self.outputs_off.val();
        self.outputs.next = self.output_control.pins.val();
        self.pwm.next = self.pulse_width.pin.val();

        self.readout.strobe.next = self.strobe.val();
        self.readout.beat.next = self.time_slot.beat.val();
        self.readout.is_last.next = self.time_slot.is_last.val();
        self.readout.snapshot.next = self.snapshot.val();
        self.readout.caught.next = self.seek_control.caught.val();
        self.readout.met.next = self.queue.met.val();
        self.readout.sweeps.next = self.seek_control.sweeps.val();
        self.readout.comes.next = self.edge_latch.comes.val();
        self.readout.latches.next = self.edge_latch.latches.val();
        self.readout.samples.next = self.switches.samples.val();
        self.readout.row.next = self.supervisor.row.val();
        self.readout.earlier.next = self.switches.earlier.val();
        self.readout.level.next = self.switches.level.val();
        self.readout.resetting.next = self.resets.resetting.val();
        self.readout.word.next = self.store.word.val();
        self.readout.live.next = self.queue.live.val();
        self.readout.running.next = self.queue.running.val();
        self.readout.room.next = self.queue.room.val();
        self.readout.on_way.next = self.step_counts.on_way.val();
        self.state_valid.next = self.readout.valid.val();
        self.state_page.next = self.readout.page.val();
        self.state_axis.next = self.time_slot.axis.val();
        self.state_item.next = self.readout.item.val();
        self.state.next = self.readout.state.val();
        self.refreshed.next = self.readout.refreshed.val();

        self.switches.time_slot_ends.next = self.time_slot.beat.val().get_bit(BEAT_LAST);
        self.switches.axis.next = self.time_slot.axis.val();
        self.switches.axis_next.next = self.time_slot.axis_next.val();
        self.switches.axis_one_hot.next = self.time_slot.axis_one_hot.val();
        self.switches.row.next = self.supervisor.row.val();
        self.switches.begins_round.next = self.supervisor.begins_round.val();
        self.switches.limit_min.next = self.limit_min.val();
        self.switches.limit_max.next = self.limit_max.val();
        self.switches.inputs_0.next = self.inputs_0.val();
        self.switches.inputs_1.next = self.inputs_1.val();
        self.switches.goes.next = self.queue.moves.val() & !self.adder.still.val();
        self.switches.back.next = self.adder.back.val();
        self.switches.resetting.next = self.resets.resetting.val();

        self.seek_control.strobe.next = self.strobe.val();
        self.seek_control.set_source.next = self.seek_source_valid.val();
        self.seek_control.source.next = self.seek_source.val();
        self.seek_control.set.next = self.seek_valid.val();
        self.seek_control.mask.next = self.seek_mask.val();
        self.seek_control.time_slot_ends.next = self.time_slot.beat.val().get_bit(BEAT_LAST);
        self.seek_control.axis.next = self.time_slot.axis.val();
        self.seek_control.axis_one_hot.next = self.time_slot.axis_one_hot.val();
        self.seek_control.row.next = self.supervisor.row.val();
        self.seek_control.samples.next = self.switches.samples.val();
        self.seek_control.state.next = self.switches.state.val();
        self.seek_control.goes_on.next = self.queue.goes_on.val();
        self.seek_control.resetting.next = self.resets.resetting.val();

        self.edge_latch.strobe.next = self.strobe.val();
        self.edge_latch.pin.next = self.latch.val();
        self.edge_latch.arm.next = self.latch_arm.val();
        self.edge_latch.resetting.next = self.resets.resetting.val();

        self.stops.strobe.next = self.strobe.val();
        self.stops.time_slot_ends.next = self.time_slot.beat.val().get_bit(BEAT_LAST);
        self.stops.axis_one_hot.next = self.time_slot.axis_one_hot.val();
        self.stops.runs.next = self.queue.running.val();
        self.stops.too_fast.next = self.queue.too_fast.val();
        self.stops.limit.next = self.switches.found.val() & !self.seek_control.forgives.val();
        self.stops.dry.next = self.queue.dry.val();
        self.stops.late.next = self.late.val();
        self.stops.pressed.next = self.supervisor.pressed.val();
        self.stops.breaks.next = (((self.put_valid.val() & self.nobody.val())
            | self.broken.val()
            | self.queue.misplaced.val()
            | self.output_control.stray.val())
            & !self.stops.fault.val())
            | (self.decides.val() & self.unfed.q.val() & !self.drops.q.val());
        self.stops.missed.next = self.supervisor.missed.val() & !self.rest_2.q.val();
        self.stops.interlock.next = self.switches.interlock.val();
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
        self.seeking.next = self.seek_control.seeking.val();
        self.hits.next = self.seek_control.hits.val();
        self.latch_armed.next = self.edge_latch.armed.val();
        self.latch_edges.next = self.edge_latch.edges.val();
        self.started.next = self.go.val();

        // Further latches, in a build that has several. Their bank replaces what the only latch of
        // another build outputs.
        for i in 0..self.latch_bank.len() {
            self.latch_bank[i].clock.next = self.clock.val();
            self.latch_bank[i].strobe.next = self.strobe.val();
            self.latch_bank[i].pins.next = self.more_latches[i].val();
            self.latch_bank[i].arm.next = self.more_latch_arm[i].val();
            self.latch_bank[i].resetting.next = self.resets.resetting.val();
            self.latch_bank[i].first_armed.next = self.edge_latch.armed.val();
            self.latch_bank[i].first_comes.next = self.edge_latch.comes.val();
            self.latch_bank[i].first_latches.next = self.edge_latch.latches.val();
            self.readout.comes.next = self.latch_bank[i].comes.val();
            self.readout.latches.next = self.latch_bank[i].latches.val();
            self.stops.breaks.next = (((self.put_valid.val() & self.nobody.val())
                | self.broken.val()
                | self.queue.misplaced.val()
                | self.output_control.stray.val()
                | self.latch_bank[i].absent.val())
                & !self.stops.fault.val())
                | (self.decides.val() & self.unfed.q.val() & !self.drops.q.val());
            self.more_latch_armed[i].next = self.latch_bank[i].armed.val();
            self.more_latch_edges[i].next = self.latch_bank[i].edges.val();
            self.latch_records[i].next = self.latch_bank[i].records.val();
            self.state_record[i].next = self.latch_bank[i].record.val();
        }
    }
}
