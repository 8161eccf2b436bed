# A minimal Debian 12 in the folder $tree. A script sources this file and sets `tree`.

# make_debian MIRROR PACKAGE,...: makes the system, with these packages, from a mirror.
make_debian() {
  debootstrap --variant=minbase --include="$2" bookworm "$tree" "$1"
}

# trust_own_certificates: makes the new system trust the certificates that were added to this
# machine. If the network inspects encrypted downloads, they come with a certificate of the network.
# The new system must trust this certificate, or the downloads fail.
trust_own_certificates() (
  shopt -s nullglob
  for certificate in /usr/local/share/ca-certificates/*.crt; do
    cp "$certificate" "$tree$certificate" || exit 1
  done
  chroot "$tree" update-ca-certificates
)

# inside FOLDER SCRIPT: runs SCRIPT in FOLDER of the new system, with the environment of a new
# login. The processes and mounts of SCRIPT end when SCRIPT ends.
inside() {
  unshare --mount --pid --fork --kill-child env -i HOME=/root TERM=dumb LANG=C.UTF-8 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin bash -c '
      set -e
      mount --bind "$0" "$0"  # the root of the new system is a mount, as on a real machine
      cd "$0"
      mount -t proc proc "$0/proc"
      mount --rbind /sys "$0/sys"
      mount --rbind /dev "$0/dev"
      exec chroot "$0" bash -c "cd $1; $2"' "$tree" "$1" "$2"
}
