# A machine without hardware for programs that speak Grbl: `carrystep serve` with a virtual board, on
# TCP port 23000. docs/senders.md says how to start it.

FROM rust:1.90-slim-bookworm AS build
WORKDIR /carrystep
COPY . .
RUN cargo build --release --locked -p carrystep-cli

FROM debian:bookworm-slim
COPY --from=build /carrystep/target/release/carrystep /usr/local/bin/
# Three axes; another file can be mounted in its place.
COPY sim/jobs/machine.toml /machine.toml
ENV CARRYSTEP_STATE=/tmp/carrystep
USER nobody
EXPOSE 23000
# As Ctrl-C: the machine comes to rest, and the command ends.
STOPSIGNAL SIGINT
ENTRYPOINT ["carrystep", "serve", "--machine", "/machine.toml", "--virtual", "--fast"]
CMD ["--tcp", "23000", "--listen", "0.0.0.0"]
