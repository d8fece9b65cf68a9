# gpt with Mesa's software Vulkan driver, lavapipe:
#
#   docker build -t gpt .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" gpt render scene.toml -o picture.exr
#
# A graphics card is passed on by the container runtime (--gpus all, --device /dev/dri), with its driver.
FROM rust:1-trixie AS build
WORKDIR /source
COPY Cargo.toml Cargo.lock ./
COPY benches benches
COPY crates crates
COPY examples examples
COPY scenes scenes
COPY shaders shaders
COPY src src
COPY tests tests
RUN cargo install --path . --locked --root /installed
RUN mkdir -p /installed/share/bash-completion/completions \
 && /installed/bin/gpt man -o /installed/share/man/man1 \
 && /installed/bin/gpt completions bash > /installed/share/bash-completion/completions/gpt

FROM debian:trixie-slim
COPY scripts/install-lavapipe /tmp/
RUN /tmp/install-lavapipe && rm -rf /tmp/install-lavapipe /var/lib/apt/lists/*
COPY --from=build /installed /usr/local
# Mesa keeps its compiled shaders here, whoever runs the container.
ENV XDG_CACHE_HOME=/tmp/cache
WORKDIR /work
ENTRYPOINT ["gpt"]
