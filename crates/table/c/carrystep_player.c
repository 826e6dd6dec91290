/* Implementation of carrystep_player.h. Places on the ramp are counted in pulses from its start. */
#include "carrystep_player.h"

#ifdef CARRYSTEP_PROGMEM
#include <avr/pgmspace.h>
#define READ(word) pgm_read_word(&(word))
#else
#define READ(word) (word)
#endif

/* The compare value of the delay at the current place of the move. */
static uint16_t delay(const carrystep_player *player)
{
    const carrystep_table *table = player->table;
    return player->at == table->ramp ? table->cruise : READ(table->compare[player->entry]);
}

/* Goes one pulse up the ramp. */
static void up(carrystep_player *player)
{
    const carrystep_group *group = &player->table->groups[player->group];
    player->at++;
    player->pulse++;
    if (player->pulse == READ(group->pulses)) {
        player->pulse = 0;
        player->entry++;
        if (player->entry == READ(group->end)) {
            player->group++;
        }
    }
}

/* Goes one pulse down the ramp, and thereby undoes one call of up(). */
static void down(carrystep_player *player)
{
    const carrystep_group *groups = player->table->groups;
    player->at--;
    if (player->pulse == 0) {
        if (player->group > 0 && player->entry == READ(groups[player->group - 1].end)) {
            player->group--;
        }
        player->entry--;
        player->pulse = READ(groups[player->group].pulses);
    }
    player->pulse--;
}

bool carrystep_start(carrystep_player *player, const carrystep_table *table, uint32_t steps, uint16_t *compare)
{
    player->table = table;
    player->left = steps;
    player->at = 0;
    player->entry = 0;
    player->pulse = 0;
    player->group = 0;
    if (steps == 0) {
        return false;
    }
    *compare = delay(player);
    return true;
}

bool carrystep_next(carrystep_player *player, uint16_t *compare)
{
    if (player->left <= 1) {
        player->left = 0; /* It stays 0 if the interrupt comes once more. */
        return false;
    }
    player->left--;
    /* The place never exceeds the number of pulses after the next one: these are the way down. */
    if (player->left <= player->at) {
        down(player);
    } else if (player->left - 1 > player->at && player->at < player->table->ramp) {
        up(player);
    }
    *compare = delay(player);
    return true;
}

void carrystep_stop(carrystep_player *player)
{
    if (player->left > player->at + 1) {
        player->left = player->at + 1;
    }
}

uint32_t carrystep_left(const carrystep_player *player)
{
    return player->left;
}
