#!/usr/bin/perl
# Faults that are put into the sources, to see that a test notices them.
#
#   mutate.pl check LIST      each fault of the list stands exactly once
#   mutate.pl put LIST LINE   puts the fault of this line into its source and
#                             prints the name of the file
#   mutate.pl learn LIST DIR  prints the list with what killed each fault;
#                             DIR/taken/LINE/result says what became of it
#
# A line of the list:  PLACE @@ FUNCTION @@ OLD @@ NEW @@ by KILLER, or, where no
# test can notice it, @@ REASON.
#   PLACE     a room of src/ and include/, or a file: solve, src/main.c
#   FUNCTION  a function or a table that is defined there once; "-": anywhere
#   OLD       a piece of its text, whole words, however it is spaced; it stands
#             there exactly once, so the shortest that does is the best
#   NEW       what stands there instead
#   KILLER    the suite or check that is tried first, because it noticed it once;
#             may be left out
use strict;
use warnings;

# The files of a place.
sub files_of {
    my ($place) = @_;
    return ($place) if -f $place;
    return sort(glob("src/$place/*.[ch]"), glob("src/$place/*.inc"),
                glob("include/$place/*.h"));
}

sub read_file {
    my ($name) = @_;
    open(my $file, '<', $name) or die "$name: $!\n";
    local $/;
    my $text = <$file>;
    close($file);
    return $text;
}

# Begin and end of what a name defines in a text; an empty list: nothing.
sub definition {
    my ($text, $name) = @_;
    return (0, length $text) if $name eq '-';
    # A function may be EACH(name), or KERNEL(name, 1).
    my $head = qr/^(?![\s#\/*}])[^;{}=]*?(?<![\w.>])\Q$name\E\b/m;
    if ($text =~ /$head(?:\)?\s*\([^;{]*|, \d+)\)\s*\{.*?\n\}/ms) {
        return ($-[0], $+[0]); # a function
    }
    if ($text =~ /$head[^;(){}=]*=\s*\{.*?\n\};/ms) {
        return ($-[0], $+[0]); # a table
    }
    if ($text =~ /$head[^;(){}=]*=[^;{]*;/ms) {
        return ($-[0], $+[0]); # a constant
    }
    return ($-[0], $+[0]) if $text =~ /^\s*\Q$name\E\s*=\s*[^,}]*/m;
    return ($-[0], $+[0]) if $text =~ /^#define\s+\Q$name\E\b(?:.*\\\n)*.*/m;
    return ();
}

# An expression for a piece of text, however it is spaced.
sub piece {
    my ($old) = @_;
    my ($expression, $last) = ('', '');
    for my $token ($old =~ /\w+|[^\w\s]/g) {
        my $apart = $last =~ /\w$/ && $token =~ /^\w/ ? '\s+' : '\s*';
        $expression .= ($last eq '' ? '' : $apart) . quotemeta($token);
        $last = $token;
    }
    $expression = '(?<!\w)' . $expression if $old =~ /^\s*\w/;
    $expression .= '(?!\w)' if $old =~ /\w\s*$/;
    return qr/$expression/;
}

# Where a fault stands: file, begin, end; or one text, why it does not.
sub find_fault {
    my ($place, $function, $old) = @_;
    my @files = files_of($place);
    return "there is no $place in src or include" unless @files;
    my (@found, $defined);
    my $expression = piece($old);
    for my $name (@files) {
        my $text = read_file($name);
        my ($begin, $end) = definition($text, $function);
        next unless defined $begin;
        $defined = 1;
        my $body = substr($text, $begin, $end - $begin);
        while ($body =~ /$expression/g) {
            push @found, [$name, $begin + $-[0], $begin + $+[0]];
        }
    }
    return "nothing called $function is defined in $place" unless $defined;
    return "$function has no '$old' any more" unless @found;
    return "$function has '$old' " . @found . ' times' if @found > 1;
    return @{ $found[0] };
}

my ($command, $list, $chosen) = @ARGV;
die "usage: mutate.pl check|put|learn LIST [LINE|DIR]\n" unless $list;
my ($number, $bad) = (0, 0);
for my $line (split(/\n/, read_file($list))) {
    $number++;
    if ($command eq 'learn') {
        my $result = "$chosen/taken/$number/result";
        if (-f $result && read_file($result) =~ /^killed by (\S+):/) {
            my $killer = $1;
            $line =~ s/ @@ by \S+$//;
            $line .= " @@ by $killer";
        }
        print "$line\n";
        next;
    }
    next if $line =~ /^(#.*)?$/ || ($chosen && $number != $chosen);
    my @field = map { s/^\s+|\s+$//gr } split(/ @@(?= |$)/, $line, -1);
    my @where = @field < 4 ? 'fields are missing' : find_fault(@field[0 .. 2]);
    if (@where == 1) {
        print "$list:$number: $where[0]: say what it is called now, ",
            "or delete the line\n";
        $bad = 1;
    } elsif ($command eq 'put') {
        my ($name, $begin, $end) = @where;
        my $text = read_file($name);
        substr($text, $begin, $end - $begin) = $field[3];
        open(my $file, '>', $name) or die "$name: $!\n";
        print $file $text;
        close($file) or die "$name: $!\n";
        print "$name\n";
    }
}
exit $bad;
