#!/usr/bin/env bash
# Finds carrystep, or builds it from the revision of this action. The next steps find it in
# $CARRYSTEP_COMMAND.
set -euo pipefail
command=${CARRYSTEP:-}
if [ -z "$command" ]; then
    root=${RUNNER_TEMP:?}/carrystep
    cargo install --locked --path "${GITHUB_ACTION_PATH:?}/../../../crates/cli" --root "$root"
    command=$root/bin/carrystep
fi
command=$(realpath "$(command -v "$command")")
"$command" --version
echo "CARRYSTEP_COMMAND=$command" >> "${GITHUB_ENV:?}"
