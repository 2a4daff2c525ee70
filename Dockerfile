# syntax=docker/dockerfile:1
# Driver, simulator and viewer with ROS 2. docs/use/container.md says how to use the image.

ARG ROS_DISTRO=jazzy
ARG UBUNTU=noble

# What the packages need to be built and tested; also the development container.
FROM ros:${ROS_DISTRO}-ros-base-${UBUNTU} AS development
ENV DEBIAN_FRONTEND=noninteractive
# hadolint ignore=DL3008
RUN --mount=type=bind,target=/src \
    echo 'APT::Install-Recommends "false";' > /etc/apt/apt.conf.d/99no-recommends \
    && apt-get update \
    && apt-get install --yes --no-install-recommends python3-pip python3-venv \
    && rosdep update --rosdistro "${ROS_DISTRO}" \
    && rosdep install --from-paths /src --ignore-src --default-yes --skip-keys rviz2 \
    && rm -rf /var/lib/apt/lists/*

FROM development AS build
SHELL ["/bin/bash", "-o", "pipefail", "-c"]
COPY . /src
RUN . "/opt/ros/${ROS_DISTRO}/setup.bash" \
    && colcon build --base-paths /src --build-base /build --install-base /opt/ur_ros_rtde --merge-install \
        --cmake-args -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=Release
# The page server of the viewer, which Ubuntu has no package of.
RUN python3 -m pip install --no-cache-dir --no-deps --require-hashes --requirement /src/wheels/viewer.txt --target /opt/viewer
RUN rosdep keys --from-paths /src --ignore-src --dependency-types exec | grep --invert-match --line-regexp rviz2 \
    | xargs rosdep resolve | grep --invert-match '^#' > /runtime_packages.txt

FROM ros:${ROS_DISTRO}-ros-core-${UBUNTU}
# hadolint ignore=DL3008
RUN --mount=type=bind,from=build,source=/runtime_packages.txt,target=/runtime_packages.txt \
    apt-get update \
    && xargs --arg-file /runtime_packages.txt apt-get install --yes --no-install-recommends python3-pygments python3-typing-extensions \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/viewer /opt/viewer
COPY --from=build /opt/ur_ros_rtde /opt/ur_ros_rtde
ENV PATH="/opt/ur_ros_rtde/lib/ur_ros_rtde:/opt/ur_ros_rtde/lib/ur_ros_rtde_cli:${PATH}" \
    PYTHONPATH=/opt/viewer \
    # Containers do not share /dev/shm, over which Fast DDS sends by default on one host.
    FASTDDS_BUILTIN_TRANSPORTS=UDPv4
USER 1000:1000
WORKDIR /home/ubuntu
ENTRYPOINT ["/bin/bash", "-c", "source /opt/ur_ros_rtde/setup.bash -- && exec \"$@\"", "--"]
CMD ["ur", "--help"]
